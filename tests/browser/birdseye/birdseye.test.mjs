import assert from 'node:assert/strict';
import { root } from '../../../scripts/lib/paths.mjs';
import { button, control, twoFrames } from '../lib/controls.mjs';
import { assertCsv, assertPng, clickWhenThere, drop, parametersWith, recording, saved, values } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { openPage, serve } from '../lib/session.mjs';
import { slideTo, typeNumber } from '../lib/type.mjs';

// One radar and a coarse image, where the test needs no more: the machine may be busy.
const path = '#/birdseye?methods=bartlett,iaa';
const small = `${path}&radars=front-left&cell=0.5`;
const cell = (method, field) => `[aria-busy="false"] [data-row="${method}"] [data-field="${field}"]`;
// Four cubes are simulated and some thousand cells estimated: that takes a busy machine its time.
const ready = (page, method = 'iaa', field = 'cells') =>
  page.waitForSelector(`${cell(method, field)}[data-value]`, { timeout: 80_000 });
const value = async (page, method, field) => (await values(page, cell(method, field)))[0];
const image = (page, method) => page.locator(`[data-plot="image-${method}"]`);
const cancelled = (page) => page.getByText('Cancelled: what is greyed is of other settings');

/** What is painted on a plot, as a number that changes with it. */
const painted = (page, method) =>
  image(page, method)
    .locator('canvas')
    .first()
    .evaluate((canvas) => {
      const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
      let sum = 0;
      for (let i = 0; i < data.length; i++) sum = (sum * 31 + data[i]) % 1_000_000_007;
      return sum;
    });

/** Waits until something else is painted than before, and returns it. */
async function repainted(page, method, before, change = 'it') {
  for (let tries = 0; tries < 200; tries++) {
    await twoFrames(page);
    const now = await painted(page, method);
    if (now !== before) return now;
  }
  assert.fail(`${change} paints nothing else`);
}

/** Turns the wheel, and waits until the page had that. */
async function wheel(page, by) {
  await page.evaluate(() => {
    window.wheeled = new Promise((done) => addEventListener('wheel', done, { capture: true, once: true }));
  });
  await page.mouse.wheel(0, by);
  await page.evaluate(() => window.wheeled.then(() => {}));
  await twoFrames(page);
}

/** The reading at a share of a plot's width and height. */
async function reading(page, method, x = 0.5, y = 0.5) {
  const over = image(page, method).locator('.u-over');
  const { width, height } = await over.boundingBox();
  await over.hover({ position: { x: width * x, y: height * y } });
  await twoFrames(page);
  const text = await image(page, method).locator('.readout').innerText();
  const [, atX, atY] = /x ([+−]?[\d.]+) m\s+y ([+−]?[\d.]+) m/.exec(text) ?? assert.fail(`the reading is “${text}”`);
  return { text, x: Number(atX.replace('−', '-')), y: Number(atY.replace('−', '-')) };
}

browserTest(
  'bird’s-eye view: four radars by two methods, and the measure says that IAA’s image is cleaner',
  { path },
  async ({ page }) => {
    for (const method of ['bartlett', 'iaa']) await ready(page, method, 'outsideDb');
    const [fft, iaa] = [await value(page, 'bartlett', 'outsideDb'), await value(page, 'iaa', 'outsideDb')];
    console.log(`# energy outside the targets: FFT ${fft.toFixed(1)} dB, IAA ${iaa.toFixed(1)} dB`);
    assert.ok(iaa < fft - 3, `IAA ${iaa} dB, FFT ${fft} dB`);
    assert.ok((await value(page, 'iaa', 'litOutside')) < (await value(page, 'bartlett', 'litOutside')));
    assert.equal(await value(page, 'iaa', 'cells'), await value(page, 'bartlett', 'cells'), 'both have the same cells');
    const cells = await values(page, '[data-table="counts"] [data-field="cells"]');
    assert.equal(cells.length, 4);
    assert.equal(
      cells.reduce((sum, n) => sum + n, 0),
      await value(page, 'iaa', 'cells'),
    );
    assert.notEqual(await painted(page, 'iaa'), await painted(page, 'bartlett'));
    assert.match(await image(page, 'iaa').locator('.detail').innerText(), /spectra, −\d+\.\d.dB outside/);
  },
);

browserTest(
  'bird’s-eye view: radars are switched off and on, truth, fields of view and opacity too',
  { path: small.replace('front-left', 'left,front-left') },
  async ({ page }) => {
    await ready(page);
    const both = await painted(page, 'iaa');
    const cells = await value(page, 'iaa', 'cells');
    await control(page, 'checkbox', 'left').uncheck();
    await page.waitForFunction(
      ([selector, before]) => Number(document.querySelector(selector)?.dataset.value) < before,
      [cell('iaa', 'cells'), cells],
    );
    const one = await repainted(page, 'iaa', both);
    assert.match((await reading(page, 'iaa', 0.9, 0.9)).text, /not seen/);
    await control(page, 'checkbox', 'front left').uncheck();
    await page.waitForSelector('[data-notice="radars"]');
    await control(page, 'checkbox', 'front left').check();
    await ready(page);
    let before = one;
    for (const change of [
      () => control(page, 'checkbox', 'Truth').uncheck(),
      () => control(page, 'checkbox', 'Fields of view').uncheck(),
      () => slideTo(control(page, 'slider', 'Opacity'), 30),
      () => control(page, 'combobox', 'Dynamic range').selectOption('20'),
      () => control(page, 'combobox', 'Colour map').selectOption('magma'),
    ]) {
      await change();
      before = await repainted(page, 'iaa', before, String(change));
    }
    await parametersWith(
      page,
      (params) =>
        params.get('radars') === 'front-left' && params.get('opacity') === '30' && params.get('truth') === '0',
    );
  },
);

browserTest(
  'bird’s-eye view: images are moved and zoomed together, by mouse and by keys',
  { path: small },
  async ({ page }) => {
    await ready(page);
    const middle = await reading(page, 'bartlett');
    assert.ok(Math.abs(middle.x - 21) < 1 && Math.abs(middle.y) < 1, middle.text);
    assert.match(middle.text, /dBFS\s+front left/);
    assert.match(
      await image(page, 'iaa').locator('.readout').innerText(),
      /x \+2[01]\.\d m\s+y [+−]?0\.\d m/,
      'the cursor is shared',
    );
    assert.ok((await reading(page, 'iaa', 0.1)).y > 15, 'left is left');
    const top = await reading(page, 'iaa', 0.5, 0);
    await wheel(page, -300);
    assert.equal(
      (await reading(page, 'iaa', 0.5, 0)).x,
      top.x,
      'a wheel over an image that is not chosen scrolls the page',
    );
    const host = image(page, 'bartlett').getByRole('application');
    await host.focus();
    await page.keyboard.press('+');
    const zoomed = await reading(page, 'iaa', 0.5, 0);
    assert.ok(Math.abs(zoomed.x - (21 + (top.x - 21) / 2)) < 0.6, `${zoomed.text}, ${top.text} before`);
    await page.keyboard.press('ArrowUp');
    assert.ok((await reading(page, 'iaa')).x > 24, 'the arrow moves the view ahead');
    await page.keyboard.press('ArrowRight');
    assert.ok((await reading(page, 'iaa')).y < -1.5, 'and to the right');
    const before = await reading(page, 'bartlett');
    const { x, y, width, height } = await image(page, 'iaa').locator('.u-over').boundingBox();
    await page.mouse.move(x + width / 2, y + height / 2);
    await page.mouse.down();
    await page.mouse.move(x + width / 2 + 40, y + height / 2 + 40, { steps: 5 });
    await page.mouse.up();
    await twoFrames(page);
    const dragged = await reading(page, 'bartlett');
    const metres = (40 * (zoomed.x - 21)) / (height / 2);
    assert.ok(
      Math.abs(dragged.x - before.x - metres) < 0.5 && Math.abs(dragged.y - before.y - metres) < 0.5,
      `${dragged.text}, ${before.text} before`,
    );
    await parametersWith(page, (params) => params.has('view'));
    await page.mouse.move(x + width / 2, y + height / 2);
    await page.mouse.down();
    await page.mouse.up();
    await wheel(page, -300);
    const closer = await reading(page, 'bartlett', 0.5, 0);
    assert.ok(
      Math.abs(closer.x - dragged.x - (zoomed.x - 21) / 2) < 0.6,
      `${closer.text}, ${dragged.text} in the middle before`,
    );
    await host.press('0');
    await parametersWith(page, (params) => !params.has('view'));
    assert.equal((await reading(page, 'iaa', 0.5, 0)).x, top.x);
  },
);

browserTest(
  'bird’s-eye view: the link brings the view back',
  { path: `${small}&seed=5&view=0:30:-5:7&from=targets&span=50` },
  async ({ page, context }) => {
    await ready(page);
    const shown = async (at) => {
      await twoFrames(at);
      return [
        await value(at, 'iaa', 'outsideDb'),
        await value(at, 'iaa', 'sources'),
        await painted(at, 'iaa'),
        await painted(at, 'bartlett'),
      ];
    };
    await page.mouse.move(0, 0);
    const first = await shown(page);
    assert.match(await image(page, 'iaa').locator('.detail').innerText(), /^targets/);
    await parametersWith(page, (params) => params.get('view') === '0:30:-5:7' && params.get('seed') === '5');
    const other = await context.newPage();
    await other.goto(page.url());
    await ready(other);
    assert.deepEqual(await shown(other), first);
    await other.close();
    await page.getByRole('button', { name: 'Next seed' }).click();
    await parametersWith(page, (params) => params.get('seed') === '6');
    await page.locator(`${cell('iaa', 'outsideDb')}[data-value]:not([data-value="${first[0]}"])`).waitFor();
  },
);

browserTest('bird’s-eye view: work is cancelled and taken up again', { path: small }, async ({ page }) => {
  const { value: share, max } = await clickWhenThere(page, '[data-progress] button');
  assert.ok(share >= 0 && share < max, `${share} of ${max}`);
  await cancelled(page).waitFor();
  assert.equal(await page.locator(`${cell('iaa', 'outsideDb')}[data-value]`).count(), 0);
  await page.getByRole('button', { name: 'Compute again' }).click();
  await ready(page);
});

browserTest('bird’s-eye view: what cannot be is said', { path: small }, async ({ page }) => {
  await ready(page);
  const reach = control(page, 'spinbutton', 'Reach');
  await typeNumber(reach, '0');
  assert.match(await page.locator('.problem:visible').innerText(), /from 2 to 300/);
  await typeNumber(reach, '300');
  await control(page, 'combobox', 'Cell').selectOption('0.1');
  const alert = page.getByRole('alert');
  await alert.filter({ hasText: /9\.4 million.*too-large/s }).waitFor();
  await typeNumber(reach, '20');
  await alert.waitFor({ state: 'detached' });
  await ready(page);
  assert.equal(await alert.count(), 0);
  const single = control(page, 'checkbox', 'Single-snapshot MUSIC');
  assert.ok(await single.isDisabled());
  assert.match(await page.locator('#method-single-snapshot-music-note').innerText(), /uniform/);
  await page.goto(`${page.url().split('#')[0]}#/birdseye?seed=-1&cell=7&radars=roof&methods=magic&view=1:0:0:1`);
  await parametersWith(
    page,
    (params) =>
      params.get('seed') === '1' &&
      params.get('methods') === 'bartlett,iaa,nomp' &&
      !params.has('view') &&
      !params.has('radars'),
  );
});

browserTest(
  'bird’s-eye view: the real capture, and what its board reported',
  { path: '#/birdseye?source=capture&methods=bartlett,iaa,single-snapshot-music' },
  async ({ page }) => {
    await ready(page);
    assert.equal(await page.locator('[data-field="outsideDb"]').count(), 0, 'nothing is measured without a truth');
    assert.match(await page.locator('.birdseye-bar .legend').innerText(), /Object the board reported/);
    const before = await painted(page, 'iaa');
    await control(page, 'slider', 'Frame').press('ArrowRight');
    await parametersWith(page, (params) => params.get('frame') === '1');
    await ready(page);
    await repainted(page, 'iaa', before);
    await ready(page, 'single-snapshot-music');
    await drop(page, [
      { name: 'cut.bin', bytes: recording('xwr16xx_crw_dca_module_2018_1015v2.bin').subarray(0, 1000) },
    ]);
    await page.getByRole('list', { name: 'Open files' }).getByText('cut.bin').waitFor();
    assert.equal(await page.getByRole('alert').count(), 0, 'files are opened on the page Capture');
  },
);

browserTest('bird’s-eye view: images and tables are saved', { path: small }, async ({ page }) => {
  await ready(page);
  assertPng(await saved(page, button(image(page, 'iaa'), 'PNG')));
  assertPng(await saved(page, button(page, 'PNG of all')));
  const rows = assertCsv(await saved(page, button(image(page, 'iaa'), 'CSV')), 'x_m,y_m,power_dbfs,radar');
  assert.ok(rows.length > 5000, `${rows.length} cells`);
  assertCsv(
    await saved(page, button(page.getByRole('region', { name: 'How clean the images are' }), 'CSV')),
    'method,from,outside_db,peak_outside_db,lit_outside_share,lit_targets_share,cells,directions,unresolved_cells,off_map,time_ms',
  );
});

browserTest(
  'bird’s-eye view: a frame of 48 channels goes from cube to image by IAA on two workers',
  { path: '#/angle' },
  async ({ browser, test }) => {
    // The package itself, as it is built: the demo's pool has as many workers as the machine allows.
    const server = await serve(root);
    test.after(() => server.close());
    const { page, problems, close } = await openPage(browser, server.url, { path: 'lib/browser.js' });
    const found = await page.evaluate(async () => {
      const [lib, { createPool }] = await Promise.all([import('/lib/browser.js'), import('/worker/browser.js')]);
      await lib.init();
      const pool = createPool({ workers: 2 });
      const { cube, radar } = await pool.simulateStreet({ seed: 1, radar: 'front-left' });
      const options = { waveform: radar.waveform, array: radar.array, angle: { method: 'iaa' } };
      const grid = { xM: [-18, 60], yM: [-24, 24], cellM: 0.2 };
      const run = async () => {
        const started = performance.now();
        const { map, cells } = await pool.imageFrame(cube, options);
        const view = await pool.birdsEyeView({ radars: [{ map, mounting: radar.mounting }], grid });
        return {
          milliseconds: performance.now() - started,
          cells: cells.rangeM.length,
          lit: view.power.filter((power) => power > 0).length,
        };
      };
      await run();
      const runs = [];
      for (let i = 0; i < 5; i++) runs.push(await run());
      pool.terminate();
      return { shape: [radar.waveform.samples, radar.waveform.loops, cube.shape[2] * cube.shape[3]], runs };
    });
    await close();
    // The package has no icon; whatever else is missing is named by its address too.
    assert.deepEqual(
      problems.filter((problem) => !/favicon|^console: Failed to load resource/.test(problem)),
      [],
    );
    assert.deepEqual(found.shape, [256, 128, 48]);
    const [{ cells, lit }] = found.runs;
    assert.ok(cells > 250 && cells < 400, `${cells} cells`);
    assert.ok(lit > 1000, `${lit} cells of the image hold something`);
    const times = found.runs.map(({ milliseconds }) => milliseconds).sort((a, b) => a - b);
    console.log(
      `# cube of 256 x 128 cells, 48 channels, to bird's-eye image: ${cells} detected cells, IAA, two workers: ${times[2].toFixed(0)} ms (median of 5; ${times[0].toFixed(0)} to ${times[4].toFixed(0)})`,
    );
  },
);

browserTest(
  'bird’s-eye view: nobody waits for quick methods behind slow ones, and what is left is told',
  { path: `${small.replace(/methods=[^&]*/, 'methods=bartlett,sparse-bayesian,learned-pursuit')}` },
  async ({ page }) => {
    const bar = page.locator('[data-progress]');
    await bar.filter({ hasText: /sparse Bayesian/i }).waitFor({ timeout: 60_000 });
    for (const method of ['bartlett', 'learned-pursuit']) {
      assert.equal(
        await page.locator(`[data-row="${method}"] [data-field="outsideDb"][data-value]`).count(),
        1,
        `${method} is there before`,
      );
    }
    await bar.getByText(/about \d+ (s|min) left/).waitFor({ timeout: 60_000 });
    await bar.getByRole('button', { name: 'Cancel' }).click();
    await cancelled(page).waitFor();
  },
);
