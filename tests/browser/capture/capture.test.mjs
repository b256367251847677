import assert from 'node:assert/strict';
import {
  assertCsv,
  assertPng,
  clickWhenThere,
  drop,
  parameters,
  parametersWith,
  recording,
  reload,
  saved,
  values,
} from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';

const path = '#/capture';
const bin = recording('xwr16xx_crw_dca_module_2018_1015v2.bin');
const cfg = recording('profile.cfg');
const ready = (page) =>
  page.waitForSelector('[aria-busy="false"] [data-table="detections"] [data-field="rangeM"][data-value]');
const cellReady = (page) => page.waitForSelector('[data-row="bartlett"] [data-field="azimuth"][data-value]');

/** Rows of the table of detections as objects. */
const detections = (page) =>
  page
    .locator('[data-table="detections"] tbody tr')
    .evaluateAll((rows) =>
      rows.map((row) =>
        Object.fromEntries(
          [...row.querySelectorAll('[data-field][data-value]')].map(({ dataset }) => [
            dataset.field,
            Number(dataset.value),
          ]),
        ),
      ),
    );

/** The strongest detection within 5 cm of a range. */
const at = (rows, rangeM) =>
  rows.filter((row) => Math.abs(row.rangeM - rangeM) <= 0.05).sort((a, b) => b.powerDb - a.powerDb)[0];

browserTest(
  'capture: the bundled recording shows both targets where the board saw them',
  { path },
  async ({ page }) => {
    await ready(page);
    const rows = await detections(page);
    const [near, far] = [at(rows, 2.95), at(rows, 4.94)];
    assert.ok(near, `a target at 2.95 m among ${JSON.stringify(rows)}`);
    assert.ok(far, `a target at 4.94 m among ${JSON.stringify(rows)}`);
    assert.ok(Math.abs(near.azimuthDeg + 10.8) <= 1, `near target at ${near.azimuthDeg} degrees`);
    assert.ok(Math.abs(far.azimuthDeg - 1.8) <= 3, `far target at ${far.azimuthDeg} degrees`);
    assert.ok(
      Math.abs(near.boardRangeM - 2.95) <= 0.02 && Math.abs(near.boardAzimuthDeg + 10.8) <= 0.1,
      'the board’s own beside it',
    );
    assert.ok(Math.abs(near.azimuthDifferenceDeg) <= 1);
    assert.match(await page.locator('[data-fact="rangeResolution"]').innerText(), /5\.08.cm/);
    assert.match(await page.locator('[data-fact="frame"]').innerText(), /16 × 2 chirps, 40\.0.ms/);
    assert.match(await page.locator('.files').innerText(), /xwr16xx_crw_dca_module_2018_1015v2\.bin/);
  },
);

browserTest('capture: every frame alone shows the near target too', { path: '#/capture?frame=3' }, async ({ page }) => {
  await ready(page);
  assert.match(await page.locator('output').first().innerText(), /frame 4 of 8/);
  const near = at(await detections(page), 2.95);
  assert.ok(near && Math.abs(near.azimuthDeg + 10.8) <= 1.5, JSON.stringify(near));
  await page.locator('input[name="frame"]').press('ArrowRight');
  await parametersWith(page, (params) => params.get('frame') === '4');
  await page.waitForFunction(() => /frame 5 of 8/.test(document.querySelector('output').textContent));
});

browserTest(
  'capture: a cell chosen from the keyboard changes the spectrum and the address',
  { path },
  async ({ page }) => {
    await ready(page);
    await cellReady(page);
    const title = () => page.locator('[data-plot="cell-spectrum"] .detail').innerText();
    assert.match(await title(), /2\.95 m/);
    const map = page.locator('[data-plot="range-doppler"] .plot');
    await map.focus();
    await page.keyboard.press('n');
    await parametersWith(page, (params) => params.has('cell'));
    const chosen = parameters(page).get('cell');
    await page.keyboard.press('ArrowRight');
    await page.waitForFunction(
      (before) => new URLSearchParams(location.hash.split('?')[1]).get('cell') !== before,
      chosen,
    );
    const [range, doppler] = chosen.split(':').map(Number);
    assert.equal(parameters(page).get('cell'), `${range + 1}:${doppler}`);
    await page.keyboard.press('Home');
    await parametersWith(page, (params) => !params.has('cell'));
    assert.match(await title(), /2\.95 m/);
  },
);

browserTest(
  'capture: why the chosen cell is a detection or none, from the keyboard, with what changes it',
  { path },
  async ({ page }) => {
    await ready(page);
    const why = (verdict) => page.waitForSelector(`[data-cell-verdict="${verdict}"]`);
    const text = async (verdict) => (await why(verdict)).innerText();
    assert.match(await text('kept'), /2\.95 m.*A detection: [\d.]+ dB over its threshold; noise -[\d.]+ dBFS by \d+/s);
    const plot = '[data-plot="range-profile"]';
    const figures = assertCsv(
      await saved(page, `${plot} [data-export="csv"]`),
      'range_m,power_dbfs,bin_power_dbfs,bin_threshold_dbfs',
    );
    const row = figures.find(([range]) => Math.abs(Number(range) - 2.95) < 0.03);
    assert.ok(Number(row[2]) > Number(row[3]), `power over threshold in ${row}`);
    assert.equal(await page.locator(`${plot} [data-series="threshold"]`).count(), 1);
    await page.locator('[data-plot="range-doppler"] .plot').focus();
    await page.keyboard.press('n');
    await page.keyboard.press('ArrowRight');
    assert.match(await text('grouped'), /stronger peak 1 range bins?.*Keep local peaks only/s);
    await page.locator('input[name="grouping"]').press(' ');
    await why('kept');
    await page.locator('[data-plot="range-doppler"] .plot').focus();
    for (let i = 0; i < 4; i++) await page.keyboard.press('ArrowUp');
    assert.match(await text('below-threshold'), /No detection: [\d.]+ dB below its threshold.*false-alarm rate/s);
  },
);

browserTest('capture: the address reproduces cell, frame and options', { path }, async ({ page, context }) => {
  await ready(page);
  await page.locator('select[name="cfar"]').selectOption('ordered-statistic');
  await page.locator('select[name="window"]').selectOption('blackman');
  await ready(page);
  await page.locator('[data-detection]:not([data-detection="board"]) .cell-button').nth(1).click();
  await parametersWith(
    page,
    (params) => params.get('cfar') === 'ordered-statistic' && params.get('window') === 'blackman' && params.has('cell'),
  );
  await ready(page);
  const first = await detections(page);
  const other = await context.newPage();
  await other.goto(page.url());
  await ready(other);
  await cellReady(other);
  assert.deepEqual(await detections(other), first);
  assert.equal(await other.locator('tr[aria-selected="true"]').count(), 1);
});

browserTest(
  'capture: files that do not go together are refused by name, and the page goes on',
  { path },
  async ({ page }) => {
    await ready(page);
    const before = await detections(page);
    const alert = page.locator('[role="alert"][data-error]');
    for (const files of [
      [
        { name: 'cut.bin', bytes: bin.subarray(0, 100_000) },
        { name: 'profile.cfg', bytes: cfg },
      ],
      [
        { name: 'empty.bin', bytes: Buffer.alloc(0) },
        { name: 'profile.cfg', bytes: cfg },
      ],
      [{ name: 'nonsense.cfg', bytes: Buffer.from('hello\n') }],
      [{ name: 'photo.jpg', bytes: Buffer.from([1, 2, 3]) }],
    ]) {
      await drop(page, files);
      await page.waitForFunction(
        (name) => document.querySelector('[role="alert"][data-error]')?.textContent.includes(name),
        files[0].name,
      );
      assert.match(await alert.getAttribute('data-error'), /^[a-z][a-z-]+$/);
      assert.match(await alert.innerText(), /expect|has no/);
      assert.deepEqual(await detections(page), before, 'the capture opened before is still shown');
    }
    await drop(page, [
      { name: 'mine.bin', bytes: bin },
      { name: 'mine.cfg', bytes: cfg },
    ]);
    await page.waitForFunction(() => document.querySelector('.files').textContent.includes('mine.bin'));
    await ready(page);
    assert.equal(await alert.count(), 0);
    assert.equal(
      await page.locator('[data-field="boardRangeM"]').count(),
      0,
      'another capture has no log of the board',
    );
    await page.locator('select[name="cfar"]').selectOption('greatest-of');
    await ready(page);
  },
);

browserTest('capture: bytes after the last whole frame are counted', { path }, async ({ page }) => {
  await ready(page);
  await drop(page, [
    { name: 'longer.bin', bytes: bin.subarray(0, 3 * 131_072 + 1000) },
    { name: 'profile.cfg', bytes: cfg },
  ]);
  await page.waitForFunction(() =>
    /All 3 frames/.test(document.querySelector('[data-action="all-frames"]').textContent),
  );
  await page.waitForFunction(() =>
    /Trailing bytes\s*1.?000/.test(document.querySelector('[data-facts="counts"]')?.innerText ?? ''),
  );
});

browserTest(
  'capture: long work shows how far it is and can be cancelled',
  { path: '#/capture?dopplerPadding=8' },
  async ({ page }) => {
    await ready(page);
    const bar = clickWhenThere(page, '[data-progress] [data-action="cancel"]');
    await drop(page, [
      { name: 'long.bin', bytes: bin, times: 60 },
      { name: 'profile.cfg', bytes: cfg },
    ]);
    const { value, max } = await bar;
    assert.ok(value >= 0 && value < max, `${value} of ${max}`);
    await page.waitForSelector('[data-cancelled]');
    assert.equal(await page.locator('[data-progress]').count(), 0);
    await page.locator('input[name="frame"]').press('ArrowRight');
    await page.waitForFunction(() => /frame 2 of 480/.test(document.querySelector('output').textContent));
    await page.waitForFunction(() =>
      within('[data-plot="range-doppler"]', 'figcaption')?.textContent.includes('Frame 2 of 480'),
    );
  },
);

/** Chooses files with the page's button, as a person does. */
async function choose(page, files) {
  const [chooser] = await Promise.all([
    page.waitForEvent('filechooser'),
    page.getByRole('button', { name: 'Open files' }).click(),
  ]);
  await chooser.setFiles(
    files.map(({ name, bytes }) => ({ name, mimeType: 'application/octet-stream', buffer: bytes })),
  );
}

browserTest(
  'capture: nothing of one capture stands under the name of another that was cancelled or failed',
  { path: '#/capture?dopplerPadding=8' },
  async ({ page }) => {
    await ready(page);
    await cellReady(page);
    const nothing = async (state) => {
      for (const what of ['[data-table]', '[data-plot]', '[data-export]'])
        assert.equal(await page.locator(what).count(), 0, `${what} ${state}`);
    };
    const bar = page.evaluate(
      () =>
        new Promise((resolve) => {
          const look = () => {
            const button = document.querySelector('[data-progress] [data-action="cancel"]');
            if (!button) return;
            observer.disconnect();
            const shown = document.querySelectorAll('[data-table], [data-plot], [data-export]').length;
            button.click();
            resolve(shown);
          };
          const observer = new MutationObserver(look);
          observer.observe(document.body, { childList: true, subtree: true });
        }),
    );
    await drop(page, [
      { name: 'long.bin', bytes: bin, times: 60 },
      { name: 'profile.cfg', bytes: cfg },
    ]);
    assert.equal(await bar, 0, 'nothing of the former capture while the new one is worked on');
    await page.waitForSelector('[data-cancelled]');
    assert.match(await page.locator('.files').innerText(), /long\.bin/);
    await nothing('after it was cancelled');
    await page.locator('input[name="frame"]').press('ArrowRight');
    await ready(page);
    assert.match(await page.locator('[data-plot="range-doppler"] figcaption').innerText(), /Frame 2 of 480/);
    await page.locator('select[name="array"]').selectOption('lrr48');
    await page.waitForSelector('[role="alert"][data-error]');
    await nothing('after an error');
    await choose(page, [
      { name: 'mine.bin', bytes: bin },
      { name: 'mine.cfg', bytes: cfg },
    ]);
    await page.waitForFunction(() => document.querySelector('.files').textContent.includes('mine.bin'));
    await page.waitForSelector('[role="alert"][data-error]');
    await nothing('of a capture that the settings do not suit');
    await page.locator('select[name="array"]').selectOption('auto');
    await ready(page);
    await cellReady(page);
  },
);

/** Remembers, without keeping them, the buffers of what is fetched. */
const rememberBuffers = `
  window.buffers = [];
  const { arrayBuffer } = Response.prototype;
  Response.prototype.arrayBuffer = async function () {
    const buffer = await arrayBuffer.call(this);
    if (buffer.byteLength === ${bin.length}) buffers.push(new WeakRef(buffer));
    return buffer;
  };
`;

browserTest(
  'capture: the samples of a capture that was closed are let go of',
  { path, before: rememberBuffers },
  async ({ page, context }) => {
    await ready(page);
    await cellReady(page);
    const cdp = await context.newCDPSession(page);
    const held = async () => {
      await cdp.send('HeapProfiler.collectGarbage');
      return page.evaluate(() => buffers.filter((buffer) => buffer.deref()).length);
    };
    assert.equal(await held(), 1);
    await page.evaluate(() => {
      location.hash = '#/capture?source=files';
    });
    await page.locator('[data-table="detections"]').waitFor({ state: 'detached' });
    // What was drawn last may hold it for a moment.
    let left = await held();
    for (let tries = 0; left > 0 && tries < 100; tries++) left = await held();
    assert.equal(left, 0);
  },
);

browserTest(
  'capture: one’s own files wait for each other, and never for the bundled ones',
  { path },
  async ({ page }) => {
    await ready(page);
    const waits = (missing) => page.waitForSelector(`[data-waiting="${missing}"]`);
    const files = () => page.locator('.files').innerText();
    await choose(page, [{ name: 'mine.bin', bytes: bin }]);
    await waits('cfg');
    assert.match(
      await page.locator('[data-waiting]').innerText(),
      /mine\.bin: the \.cfg that the radar ran with is missing/,
    );
    assert.match(await files(), /mine\.bin/);
    assert.doesNotMatch(await files(), /profile\.cfg|xwr16xx/);
    assert.equal(await page.locator('[data-table], [data-plot]').count(), 0);
    await drop(page, [{ name: 'wrong.cfg', bytes: Buffer.from('hello\n') }]);
    await page.waitForSelector('[role="alert"][data-error]');
    await waits('cfg');
    await drop(page, [{ name: 'mine.cfg', bytes: cfg }]);
    await ready(page);
    assert.match(await files(), /mine\.bin[\s\S]*mine\.cfg/);
    await page.getByRole('button', { name: 'Bundled capture' }).click();
    await page.waitForFunction(() => document.querySelector('.files').textContent.includes('xwr16xx'));
    // In any order, and none is lost.
    await drop(page, [{ name: 'mine.dat', bytes: recording('xwr16xx_crw_demo_visualizer_2018_1015v2.dat') }]);
    await waits('bin,cfg');
    await drop(page, [{ name: 'mine.cfg', bytes: cfg }]);
    await waits('bin');
    await drop(page, [{ name: 'mine.bin', bytes: bin }]);
    await ready(page);
    assert.match(await files(), /mine\.bin[\s\S]*mine\.cfg[\s\S]*mine\.dat/);
    assert.ok((await page.locator('[data-field="boardRangeM"]').count()) > 0, 'the log is beside it');
  },
);

browserTest('capture: a click on a cell does not send the capture again', { path }, async ({ page }) => {
  await ready(page);
  await page.addInitScript(() => {
    window.sent = 0;
    const post = Worker.prototype.postMessage;
    Worker.prototype.postMessage = function (message, transfer) {
      for (const buffer of transfer ?? []) window.sent += buffer.byteLength ?? 0;
      return post.call(this, message, transfer);
    };
  });
  await reload(page);
  await ready(page);
  await cellReady(page);
  const pick = async (nth) => {
    await page.locator('[data-detection]:not([data-detection="board"]) .cell-button').nth(nth).click();
    await parametersWith(page, (params) => params.has('cell'));
    await page.waitForFunction(() => !document.querySelector('[data-table="cell"] tr[aria-busy="true"]'));
  };
  // A worker that had nothing to do with it yet gets it once.
  await pick(1);
  await pick(2);
  const before = await page.evaluate(() => window.sent);
  for (const nth of [0, 1, 2]) await pick(nth);
  const more = (await page.evaluate(() => window.sent)) - before;
  assert.ok(before >= bin.length, 'what is sent is counted');
  const workers = 4;
  assert.ok(more <= workers * bin.length, `${more} bytes for nine estimates`);
});

browserTest('capture: the table sorts', { path }, async ({ page }) => {
  await ready(page);
  await page.locator('[data-table="detections"] button.sort', { hasText: 'Range' }).first().click();
  const ranges = await values(page, '[data-table="detections"] [data-field="rangeM"]');
  assert.deepEqual(
    ranges,
    [...ranges].sort((a, b) => a - b),
  );
  assert.equal(await page.locator('th[aria-sort="ascending"]').count(), 1);
});

browserTest('capture: plots and tables are saved as PNG and CSV', { path }, async ({ page }) => {
  await ready(page);
  await cellReady(page);
  for (const plot of ['range-profile', 'range-doppler', 'cell-spectrum'])
    assertPng(await saved(page, `[data-plot="${plot}"] [data-export="png"]`));
  assert.equal(
    assertCsv(
      await saved(page, '[data-plot="range-profile"] [data-export="csv"]'),
      'range_m,power_dbfs,bin_power_dbfs,bin_threshold_dbfs',
    ).length,
    256,
  );
  assert.equal(
    assertCsv(await saved(page, '[data-plot="range-doppler"] [data-export="csv"]'), 'range_m,rate_mps,power_dbfs')
      .length,
    256 * 16,
  );
  const spectrum = await saved(page, '[data-plot="cell-spectrum"] [data-export="csv"]');
  assertCsv(spectrum, 'azimuth_deg,bartlett_dbfs,capon_dbfs,iaa_dbfs');
  const table = await saved(page, '[data-table="detections"] [data-export="csv"]');
  assert.match(
    table.bytes.toString().split('\r\n')[0],
    /^range_bin,doppler_bin,range_m,rate_mps,azimuth_deg,.*board_azimuth_deg,range_difference_m,azimuth_difference_deg$/,
  );
});

browserTest(
  'capture: a source that was left while it was being opened does not come back',
  { path },
  async ({ page }) => {
    await ready(page);
    const example = (name) => page.getByRole('list', { name: 'Examples' }).getByRole('link', { name });
    await example('Azimuth and elevation').click();
    await parametersWith(page, (params) => params.get('source') === 'simulated');
    await example('Regions by networks').click();
    // Networks run on the same workers, after the simulation.
    await page.waitForSelector('[data-table="regions"] [data-region]', { timeout: 60_000 });
    assert.equal((await parameters(page)).get('source'), null);
    assert.equal(await example('Regions by networks').getAttribute('aria-current'), 'true');
  },
);
