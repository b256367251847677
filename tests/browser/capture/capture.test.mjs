import assert from 'node:assert/strict';
import { button, cancelOf, checkbox, choose, combobox, figure, plotOf, progress, region } from '../lib/controls.mjs';
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
import { captionOf, cells, chosenRow, frameSays, frameSlider, frames, opened, ready } from './page.mjs';

const path = '#/capture';
const bin = recording('xwr16xx_crw_dca_module_2018_1015v2.bin');
const cfg = recording('profile.cfg');
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
  await frameSays(page, 'frame 4 of 8');
  const near = at(await detections(page), 2.95);
  assert.ok(near && Math.abs(near.azimuthDeg + 10.8) <= 1.5, JSON.stringify(near));
  await frameSlider(page).press('ArrowRight');
  await parametersWith(page, (params) => params.get('frame') === '4');
  await frameSays(page, 'frame 5 of 8');
});

browserTest(
  'capture: a cell chosen from the keyboard changes the spectrum and the address',
  { path },
  async ({ page }) => {
    await ready(page);
    await cellReady(page);
    const near = figure(page, 'Angle spectrum').locator('.detail', { hasText: '2.95 m' });
    await near.waitFor();
    await plotOf(page, 'Range-Doppler map').focus();
    await page.keyboard.press('n');
    await parametersWith(page, (params) => params.has('cell'));
    const chosen = parameters(page).get('cell');
    await page.keyboard.press('ArrowRight');
    await parametersWith(page, (params) => params.get('cell') !== chosen);
    const [range, doppler] = chosen.split(':').map(Number);
    assert.equal(parameters(page).get('cell'), `${range + 1}:${doppler}`);
    await page.keyboard.press('Home');
    await parametersWith(page, (params) => !params.has('cell'));
    await near.waitFor();
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
    const plot = figure(page, 'Range profile');
    const figures = assertCsv(
      await saved(page, button(plot, 'CSV')),
      'range_m,power_dbfs,bin_power_dbfs,bin_threshold_dbfs',
    );
    const row = figures.find(([range]) => Math.abs(Number(range) - 2.95) < 0.03);
    assert.ok(Number(row[2]) > Number(row[3]), `power over threshold in ${row}`);
    assert.equal(await plot.locator('[data-series="threshold"]').count(), 1);
    await plotOf(page, 'Range-Doppler map').focus();
    await page.keyboard.press('n');
    await page.keyboard.press('ArrowRight');
    assert.match(await text('grouped'), /stronger peak 1 range bins?.*Keep local peaks only/s);
    await checkbox(page, 'Keep local peaks only').press(' ');
    await why('kept');
    await plotOf(page, 'Range-Doppler map').focus();
    for (let i = 0; i < 4; i++) await page.keyboard.press('ArrowUp');
    assert.match(await text('below-threshold'), /No detection: [\d.]+ dB below its threshold.*false-alarm rate/s);
  },
);

browserTest('capture: the address reproduces cell, frame and options', { path }, async ({ page, context }) => {
  await ready(page);
  await combobox(page, 'Threshold').selectOption('ordered-statistic');
  await combobox(page, 'Range window').selectOption('blackman');
  await ready(page);
  await cells(page).nth(1).click();
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
  assert.equal(await chosenRow(other).count(), 1);
});

browserTest(
  'capture: files that do not go together are refused by name, and the page goes on',
  { path },
  async ({ page }) => {
    await ready(page);
    const before = await detections(page);
    const alert = page.getByRole('alert');
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
      await alert.filter({ hasText: files[0].name }).waitFor();
      assert.match(await alert.getAttribute('data-error'), /^[a-z][a-z-]+$/);
      assert.match(await alert.innerText(), /expect|has no/);
      assert.deepEqual(await detections(page), before, 'the capture opened before is still shown');
    }
    await drop(page, [
      { name: 'mine.bin', bytes: bin },
      { name: 'mine.cfg', bytes: cfg },
    ]);
    await opened(page, 'mine.bin');
    await ready(page);
    assert.equal(await alert.count(), 0);
    assert.equal(
      await page.locator('[data-field="boardRangeM"]').count(),
      0,
      'another capture has no log of the board',
    );
    await combobox(page, 'Threshold').selectOption('greatest-of');
    await ready(page);
  },
);

browserTest('capture: bytes after the last whole frame are counted', { path }, async ({ page }) => {
  await ready(page);
  await drop(page, [
    { name: 'longer.bin', bytes: bin.subarray(0, 3 * 131_072 + 1000) },
    { name: 'profile.cfg', bytes: cfg },
  ]);
  await button(frames(page), 'All 3 frames').waitFor();
  await page.waitForFunction(() =>
    /Trailing bytes\s*1.?000/.test(document.querySelector('[data-facts="counts"]')?.innerText ?? ''),
  );
});

browserTest(
  'capture: long work shows how far it is and can be cancelled',
  { path: '#/capture?dopplerPadding=8' },
  async ({ page }) => {
    await ready(page);
    const bar = clickWhenThere(page, cancelOf('Processing'));
    await drop(page, [
      { name: 'long.bin', bytes: bin, times: 60 },
      { name: 'profile.cfg', bytes: cfg },
    ]);
    const { value, max } = await bar;
    assert.ok(value >= 0 && value < max, `${value} of ${max}`);
    await page.waitForSelector('[data-cancelled]');
    assert.equal(await progress(page, 'Processing').count(), 0);
    await frameSlider(page).press('ArrowRight');
    await frameSays(page, 'frame 2 of 480');
    await captionOf(page, 'Range-Doppler map', 'Frame 2 of 480');
  },
);

browserTest(
  'capture: nothing of one capture stands under the name of another that was cancelled or failed',
  { path: '#/capture?dopplerPadding=8' },
  async ({ page }) => {
    await ready(page);
    await cellReady(page);
    const nothing = async (state) => {
      const saves = page.getByRole('button', { name: /^(PNG|SVG|CSV|JSON|TI line)$/ });
      for (const what of [page.locator('[data-table]'), page.locator('[data-plot]'), saves])
        assert.equal(await what.count(), 0, `${what} ${state}`);
    };
    const bar = page.evaluate(
      (cancel) =>
        new Promise((resolve) => {
          const look = () => {
            const button = document.querySelector(cancel);
            if (!button) return;
            observer.disconnect();
            const shown = document.querySelectorAll('[data-table], [data-plot], [data-export]').length;
            button.click();
            resolve(shown);
          };
          const observer = new MutationObserver(look);
          observer.observe(document.body, { childList: true, subtree: true });
        }),
      cancelOf('Processing'),
    );
    await drop(page, [
      { name: 'long.bin', bytes: bin, times: 60 },
      { name: 'profile.cfg', bytes: cfg },
    ]);
    assert.equal(await bar, 0, 'nothing of the former capture while the new one is worked on');
    await page.waitForSelector('[data-cancelled]');
    assert.match(await page.locator('.files').innerText(), /long\.bin/);
    await nothing('after it was cancelled');
    await frameSlider(page).press('ArrowRight');
    await ready(page);
    await captionOf(page, 'Range-Doppler map', 'Frame 2 of 480');
    await combobox(page, 'Virtual array').selectOption('lrr48');
    await page.getByRole('alert').waitFor();
    await nothing('after an error');
    await choose(page, button(page, 'Open files'), [
      { name: 'mine.bin', bytes: bin },
      { name: 'mine.cfg', bytes: cfg },
    ]);
    await opened(page, 'mine.bin');
    await page.getByRole('alert').waitFor();
    await nothing('of a capture that the settings do not suit');
    await combobox(page, 'Virtual array').selectOption('auto');
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
    await choose(page, button(page, 'Open files'), [{ name: 'mine.bin', bytes: bin }]);
    await waits('cfg');
    assert.match(
      await page.locator('[data-waiting]').innerText(),
      /mine\.bin: the \.cfg that the radar ran with is missing/,
    );
    assert.match(await files(), /mine\.bin/);
    assert.doesNotMatch(await files(), /profile\.cfg|xwr16xx/);
    assert.equal(await page.locator('[data-table], [data-plot]').count(), 0);
    await drop(page, [{ name: 'wrong.cfg', bytes: Buffer.from('hello\n') }]);
    await page.getByRole('alert').waitFor();
    await waits('cfg');
    await drop(page, [{ name: 'mine.cfg', bytes: cfg }]);
    await ready(page);
    assert.match(await files(), /mine\.bin[\s\S]*mine\.cfg/);
    await button(page, 'Bundled capture').click();
    await opened(page, 'xwr16xx');
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
    await cells(page).nth(nth).click();
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
  await button(region(page, 'Detections'), 'Range (m)').first().click();
  await page.locator('th[aria-sort="ascending"]').waitFor();
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
  const save = (from, as) => saved(page, button(from, as));
  const [profile, map, cell] = ['Range profile', 'Range-Doppler map', 'Angle spectrum'].map((name) =>
    figure(page, name),
  );
  for (const plot of [profile, map, cell]) assertPng(await save(plot, 'PNG'));
  assert.equal(
    assertCsv(await save(profile, 'CSV'), 'range_m,power_dbfs,bin_power_dbfs,bin_threshold_dbfs').length,
    256,
  );
  assert.equal(assertCsv(await save(map, 'CSV'), 'range_m,rate_mps,power_dbfs').length, 256 * 16);
  const spectrum = await save(cell, 'CSV');
  assertCsv(spectrum, 'azimuth_deg,bartlett_dbfs,capon_dbfs,iaa_dbfs');
  const table = await save(region(page, 'Detections'), 'CSV');
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
