import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { root } from '../../../scripts/lib/paths.mjs';
import { clouds } from '../../node/lib/clouds.mjs';
import { control, twoFrames } from '../lib/controls.mjs';
import {
  assertCsv,
  assertJson,
  assertPng,
  clickWhenThere,
  drop,
  parametersWith,
  recordings,
  reload,
  saved,
  values,
} from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { typeNumber } from '../lib/type.mjs';

const path = '#/mounting';
const golden = (name) => join(root, 'tests', 'golden', name);
const cell = (method, field) => `[aria-busy="false"] [data-row="${method}"] [data-field="${field}"]`;
const ready = (page, method = 'recursive') => page.waitForSelector(`${cell(method, 'angleDeg')}[data-value]`);
const value = async (page, method, field) => (await values(page, cell(method, field)))[0];
const placeAhead = (page) => control(page, 'spinbutton', 'Ahead of rear axle');
const timeSlider = (page) => control(page, 'slider', 'Time');
const alert = (page) => page.getByRole('alert');
const plot = (page, name) => page.locator(`[data-plot="${name}"]`);
const results = (page) => page.getByRole('region', { name: /^Mounting angle of radar \d$/ });
const save = (scope, kind) => control(scope, 'button', kind);
/** Waits until a drive is open whose name and format are such. */
const driveIs = (page, name) => page.locator('[data-fact="name"]').filter({ hasText: name }).waitFor();
const atFrame = (page, number) => control(page, 'region', 'Time').getByText(`frame ${number} of`).waitFor();
/** Waits until the frame that is shown lies between two. */
const frameBetween = (page, low, high) =>
  page.waitForFunction(
    ([low, high]) => {
      const [, at] = /frame (\d+) of/.exec(document.querySelector('output[data-time]').textContent);
      return Number(at) > low && Number(at) < high;
    },
    [low, high],
  );
const frameNumber = async (page) =>
  Number(/frame (\d+) of/.exec(await page.locator('output[data-time]').innerText())[1]);

/** Tables of a drive: a radar at 3.5 m, turned by 2 degrees, past standing things; the car swings left and right. */
function tables() {
  const [detections, motion] = [['time_s,azimuth_deg,range_rate_mps,range_m'], ['time_s,yaw_rate_degps,speed_mps']];
  let seed = 1;
  const noise = () => {
    seed = (seed * 48271) % 2147483647;
    return (seed / 2147483647 - 0.5) * 0.1;
  };
  for (let i = 0; i < 400; i++) {
    const t = i * 0.075;
    const yawRate = 12 * Math.sin(t / 2);
    const speed = 10 + 3 * Math.sin(t / 5);
    motion.push(`${t.toFixed(3)},${yawRate.toFixed(6)},${speed.toFixed(6)}`);
    for (let k = 0; k < 24; k++) {
      const azimuth = -55 + 4.7 * k;
      const direction = ((azimuth + 2) * Math.PI) / 180;
      const rate = -(speed * Math.cos(direction) + ((yawRate * Math.PI) / 180) * 3.5 * Math.sin(direction));
      detections.push(`${t.toFixed(3)},${azimuth.toFixed(3)},${(rate + noise()).toFixed(5)},${10 + k}`);
    }
  }
  return [
    { name: 'detections.csv', bytes: Buffer.from(`${detections.join('\n')}\n`) },
    { name: 'motion.csv', bytes: Buffer.from(`${motion.join('\n')}\n`) },
  ];
}

browserTest(
  'mounting angle: the bundled drive loads by itself and gives the angle its makers state',
  { path },
  async ({ page }) => {
    await ready(page);
    assert.equal((await values(page, '[data-field="truth"]'))[0], -1.96);
    const [angle, sigma] = [await value(page, 'recursive', 'angleDeg'), await value(page, 'recursive', 'sigmaDeg')];
    assert.ok(Math.abs(angle + 1.94) < 0.1, `recursive: ${angle}`);
    assert.ok(sigma > 0.01 && sigma < 0.15, `recursive: +-${sigma}`);
    await ready(page, 'weighted-mean');
    assert.ok(Math.abs((await value(page, 'weighted-mean', 'angleDeg')) + 2) < 0.2);
    assert.equal(await page.locator(cell('weighted-mean', 'scaleSigma')).innerText(), 'fixed');
    assert.equal(await page.locator(cell('recursive', 'misaligned')).innerText(), 'yes');
    const counted = await Promise.all(
      ['used', 'standing', 'slow', 'turning', 'sparse', 'offSpeed', 'withoutMotion'].map((field) =>
        value(page, 'recursive', field),
      ),
    );
    assert.equal(
      counted.reduce((sum, frames) => sum + frames, 0),
      12_003,
      'every frame is counted once',
    );
    assert.match(await page.locator('[data-fact="frames"]').innerText(), /12.003 at 20\.0.Hz/);
    assert.match(await page.locator('[data-facts="counts"]').innerText(), /Without range rate\s*192/);
    assert.match(
      await page.locator('[data-plot="trajectory"] .legend').innerText(),
      /Angle found, −(1\.9|2\.0)\d°, RTE [\d.]+ m[\s\S]*Nominal angle, 0\.00°, RTE [\d.]+ m[\s\S]*Poses of the log/,
    );
    await page.waitForSelector('[data-plot="doppler-azimuth"] [data-series="recursive"]');
  },
);

browserTest(
  'mounting angle: slider, keys and playback move through the frames',
  { path: '#/mounting?methods=weighted-mean&t=100' },
  async ({ page }) => {
    await ready(page, 'weighted-mean');
    const before = await frameNumber(page);
    assert.ok(Math.abs(before - 2005) < 10, `frame ${before} at 100 s`);
    await timeSlider(page).press('ArrowRight');
    await atFrame(page, before + 1);
    await plot(page, 'birds-eye').getByRole('application').press('Shift+ArrowRight');
    await atFrame(page, before + 11);
    await page.locator('#content').evaluate((node) => node.focus());
    await page.keyboard.press('ArrowLeft');
    await atFrame(page, before + 10);
    await plot(page, 'doppler-azimuth')
      .locator('figcaption')
      .filter({ hasText: `frame ${before + 10}:` })
      .waitFor();
    await page.keyboard.press('Space');
    await page.getByRole('button', { name: 'Pause', pressed: true }).waitFor();
    await frameBetween(page, before + 15, 12_003);
    await page.keyboard.press('Space');
    await page.getByRole('button', { name: 'Play', pressed: false }).waitFor();
    // A click on a plot over time goes there.
    const over = plot(page, 'angle-history').locator('.u-over');
    await over.click({ position: { x: (await over.boundingBox()).width / 2, y: 40 } });
    await frameBetween(page, 5960, 6040);
  },
);

browserTest(
  'mounting angle: plots over time share a zoom of time, each has its own of values',
  { path: '#/mounting?methods=weighted-mean' },
  async ({ page }) => {
    await ready(page, 'weighted-mean');
    const readout = async (name) => {
      const over = plot(page, name).locator('.u-over');
      const { width, height } = await over.boundingBox();
      await over.hover({ position: { x: width / 2, y: height / 2 } });
      await twoFrames(page);
      return plot(page, name).locator('.readout').innerText();
    };
    const numbers = (text) => [...text.replaceAll('−', '-').matchAll(/[+-]?\d+\.\d+/g)].map(Number);
    const [, middle] = numbers(await readout('angle-history'));
    const { x, y, width, height } = await plot(page, 'angle-history').locator('.u-over').boundingBox();
    await page.mouse.move(x + width / 2, y + 2);
    await page.mouse.down();
    await page.mouse.move(x + width * 0.75, y + height / 2, { steps: 5 });
    await page.mouse.up();
    const [time, angle] = numbers(await readout('angle-history'));
    assert.ok(Math.abs(time - 375) < 3, `${time} s`);
    assert.ok(angle > middle + 0.02, `${angle} degrees, ${middle} before`);
    assert.ok(Math.abs(numbers(await readout('frame-weights'))[0] - 375) < 3, 'the other plot has the same time');
    await plot(page, 'frame-weights').getByRole('application').press('0');
    assert.ok(Math.abs(numbers(await readout('angle-history'))[0] - 300) < 3, 'and shows all of it again');
  },
);

browserTest(
  'mounting angle: general tables are dropped, and say where the radar is not',
  { path: '#/mounting?methods=recursive,weighted-mean' },
  async ({ page }) => {
    await ready(page);
    await drop(page, tables());
    await page.waitForSelector('[data-notice="place"]');
    assert.equal(await page.locator('[data-field="truth"]').count(), 0, 'nothing is known of the true angle');
    await typeNumber(placeAhead(page), '3.5');
    await ready(page, 'weighted-mean');
    for (const method of ['weighted-mean', 'recursive']) {
      const angle = await value(page, method, 'angleDeg');
      assert.ok(Math.abs(angle - 2) < 0.1, `${method}: ${angle}`);
      assert.equal(await page.locator(cell(method, 'misaligned')).innerText(), '–', 'no alarm without a nominal angle');
    }
    await typeNumber(control(page, 'spinbutton', 'Nominal angle'), '2');
    await page.waitForFunction(
      (selector) => document.querySelector(selector)?.textContent === 'no',
      cell('recursive', 'misaligned'),
    );
    assert.match(await page.locator('[data-plot="trajectory"] .legend').innerText(), /Speed and yaw rate as measured/);
    await parametersWith(page, (params) => params.get('source') === 'files' && params.get('xM') === '3.5');
    await reload(page);
    await page
      .getByRole('status')
      .filter({ hasText: /files that are not here/ })
      .waitFor();
  },
);

browserTest(
  'mounting angle: a folder is looked through, dropped or chosen',
  { path: '#/mounting?source=simulated&duration=5&methods=weighted-mean' },
  async ({ page }) => {
    await page.waitForSelector('[data-fact="name"]');
    await page.getByLabel('Drive folder').setInputFiles(recordings('delphi'));
    await driveIs(page, 'delphi, delphi');
    await ready(page, 'weighted-mean');
    assert.match(await page.locator('.files').innerText(), /front_radar\.csv\.gz[\s\S]*pose_10hz\.csv\.gz/);
    // What a file manager drops cannot be made by a script; its folder is, with the files that are in it.
    await page.evaluate(
      (files) => {
        const entries = files.map(({ name, text }) => ({
          isFile: true,
          isDirectory: false,
          fullPath: `/mine/${name}`,
          file: (resolve) => resolve(new File([text], name)),
        }));
        const batches = [entries.slice(0, 1), entries.slice(1), []];
        const folder = {
          isFile: false,
          isDirectory: true,
          fullPath: '/mine',
          createReader: () => ({ readEntries: (resolve) => resolve(batches.shift()) }),
        };
        DataTransferItem.prototype.webkitGetAsEntry = () => folder;
        const transfer = new DataTransfer();
        transfer.items.add(new File([], 'mine'));
        window.dispatchEvent(new DragEvent('drop', { dataTransfer: transfer, bubbles: true, cancelable: true }));
      },
      [...tables().map(({ name, bytes }) => ({ name, text: bytes.toString() })), { name: 'notes.txt', text: 'hello' }],
    );
    await driveIs(page, 'mine, csv');
  },
);

browserTest(
  'mounting angle: a RadarScenes sequence of two scans opens, and no angle is claimed from it',
  { path: '#/mounting?source=simulated&duration=5&methods=recursive' },
  async ({ page }) => {
    await page.waitForSelector('[data-fact="name"]');
    await drop(page, [{ name: 'radar_data.h5', bytes: readFileSync(golden('radarscenes/deflated.h5')) }]);
    await driveIs(page, 'radar_data, radarscenes');
    await page.waitForSelector(`${cell('recursive', 'sigmaDeg')}[data-value]`);
    assert.equal(await page.locator(cell('recursive', 'sigmaDeg')).innerText(), 'not determined');
    assert.equal(await page.locator(cell('recursive', 'angleDeg')).innerText(), '–');
    assert.match(await page.locator('[data-table="results"] .warnings').innerText(), /no-frames/);
    assert.equal(await control(page, 'combobox', 'Radar').getByRole('option').count(), 2);
    assert.match(
      await page.locator('[data-plot="birds-eye"] .legend').innerText(),
      /Ring: moving by the drive’s own labels/,
    );
  },
);

browserTest(
  'mounting angle: clouds of nuScenes are dropped with their tables',
  { path: '#/mounting?source=simulated&duration=5&methods=recursive' },
  async ({ page }) => {
    await page.waitForSelector('[data-fact="name"]');
    await drop(page, clouds());
    await driveIs(page, ', pcd');
    await ready(page);
    assert.ok(Math.abs((await value(page, 'recursive', 'angleDeg')) - 2) < 0.1);
    assert.equal(await placeAhead(page).inputValue(), '3.5');
    const remarks = page.getByRole('region', { name: 'What was left out of the files, and remarks' });
    await remarks.getByText(/differences of the poses/).waitFor();
  },
);

browserTest(
  'mounting angle: what is no drive is refused by name, and the page goes on',
  { path: '#/mounting?methods=weighted-mean' },
  async ({ page }) => {
    await ready(page, 'weighted-mean');
    const before = await value(page, 'weighted-mean', 'angleDeg');
    const [detections, motion] = tables();
    const backwards = Buffer.from(detections.bytes.toString().replace(/\n0\.075,/, '\n-9,'));
    for (const [files, code] of [
      [[{ name: 'photo.jpg', bytes: Buffer.from([1, 2, 3]) }], 'no-drive-log'],
      [[{ name: 'cut.h5', bytes: Buffer.from('\x89HDF\r\n\x1a\n', 'latin1') }], 'malformed-hdf5'],
      [[{ name: 'list.csv', bytes: Buffer.from('a,b\n1,2\n') }], 'malformed-table'],
      [[{ name: 'turned.csv', bytes: backwards }, motion], 'time-backwards'],
      [
        [
          { name: 'a.h5', bytes: Buffer.alloc(9) },
          { name: 'b.h5', bytes: Buffer.alloc(9) },
        ],
        'ambiguous',
      ],
    ]) {
      await drop(page, files);
      const named = files.length === 1 ? files[0].name : '2 files';
      await alert(page).filter({ hasText: code }).filter({ hasText: named }).waitFor();
      assert.equal(await value(page, 'weighted-mean', 'angleDeg'), before, 'the drive opened before is still shown');
    }
    await drop(page, [detections, motion]);
    await page.waitForSelector('[data-notice="place"]');
    assert.equal(await alert(page).count(), 0);
  },
);

browserTest(
  'mounting angle: work is cancelled and taken up again, and a change starts it anew',
  { path: '#/mounting?methods=least-squares' },
  async ({ page }) => {
    const { value: share, max } = await clickWhenThere(page, '[data-progress] button');
    assert.ok(share >= 0 && share < max, `${share} of ${max}`);
    await page.waitForSelector('[data-cancelled]');
    assert.equal(await page.locator('[data-row="least-squares"] [data-field="angleDeg"]').count(), 0);
    await control(page, 'button', 'Calibrate again').click();
    await ready(page, 'least-squares');
    const used = await value(page, 'least-squares', 'used');
    await typeNumber(control(page, 'spinbutton', 'Slowest'), '10');
    await page.waitForFunction(
      ([selector, before]) => Number(document.querySelector(selector)?.dataset.value) < before,
      [cell('least-squares', 'used'), used],
    );
    await parametersWith(page, (params) => params.get('minSpeed') === '10');
  },
);

browserTest(
  'mounting angle: opening is cancelled and taken up again',
  { path: '#/mounting?source=simulated&duration=300&methods=weighted-mean' },
  async ({ page }) => {
    await clickWhenThere(page, '[data-opening] button');
    await page.waitForSelector('[data-interrupted]');
    assert.equal(await page.locator('[data-fact="name"]').count(), 0);
    await typeNumber(control(page, 'spinbutton', 'Duration'), '10');
    await page.waitForSelector('[data-fact="name"]');
    await ready(page, 'weighted-mean');
    assert.equal(await page.locator('[data-interrupted]').count(), 0);
  },
);

browserTest(
  'mounting angle: a simulated drive has its truth beside it, and the link brings it back',
  {
    path: '#/mounting?source=simulated&scenario=country-road&duration=40&seed=3&misalignment=-1&sensor=2&methods=recursive,kabsch,joint',
  },
  async ({ page }) => {
    await ready(page);
    const truth = (await values(page, '[data-field="truth"]'))[0];
    assert.ok(Math.abs(truth + 24.99) < 0.02, `radar 2 looks to ${truth} degrees`);
    for (const method of ['recursive', 'joint']) {
      await ready(page, method);
      const [error, sigma] = [await value(page, method, 'error'), await value(page, method, 'sigmaDeg')];
      assert.ok(Math.abs(error) < 5 * sigma && sigma < 0.5, `${method}: ${error} +- ${sigma}`);
    }
    await control(page, 'combobox', 'Radar').selectOption('3');
    await control(page, 'region', 'Mounting angle of radar 3').waitFor();
    await ready(page);
    await timeSlider(page).press('ArrowRight');
    await control(page, 'combobox', 'Band').selectOption('2');
    await parametersWith(
      page,
      (params) => params.get('sensor') === '3' && params.get('band') === '2' && params.has('t'),
    );
    const shown = [
      await frameNumber(page),
      await value(page, 'recursive', 'angleDeg'),
      await value(page, 'kabsch', 'angleDeg'),
    ];
    await reload(page);
    await ready(page);
    await ready(page, 'kabsch');
    assert.deepEqual(
      [await frameNumber(page), await value(page, 'recursive', 'angleDeg'), await value(page, 'kabsch', 'angleDeg')],
      shown,
    );
    assert.equal(await control(page, 'combobox', 'Band').inputValue(), '2');
  },
);

browserTest(
  'mounting angle: the page stays awake while a long drive is simulated and calibrated',
  { path: '#/mounting?source=simulated&duration=600&methods=weighted-mean,joint' },
  async ({ page }) => {
    // Frames are drawn during the work: a page that computes by itself draws none. The joint method
    // takes seconds, so that a fast machine draws many of them.
    await page.evaluate(() => {
      window.drawn = { opening: 0, calibrating: 0 };
      const tick = () => {
        if (document.querySelector('.loading')) window.drawn.opening += 1;
        if (document.querySelector('[data-progress]')) window.drawn.calibrating += 1;
        requestAnimationFrame(tick);
      };
      tick();
    });
    await ready(page, 'weighted-mean');
    await ready(page, 'joint');
    const drawn = await page.evaluate(() => window.drawn);
    assert.ok(drawn.opening > 10 && drawn.calibrating > 10, JSON.stringify(drawn));
  },
);

browserTest(
  'mounting angle: plots are saved as PNG and CSV',
  { path: '#/mounting?methods=recursive' },
  async ({ page }) => {
    await ready(page);
    for (const name of ['angle-history', 'doppler-azimuth', 'birds-eye', 'frame-weights', 'trajectory'])
      assertPng(await saved(page, save(plot(page, name), 'PNG')));
    const csv = (name) => saved(page, save(plot(page, name), 'CSV'));
    const history = assertCsv(await csv('angle-history'), 'method,time_s,angle_deg,sigma_deg');
    assert.ok(history.length > 500, `${history.length} entries a second apart`);
    assertCsv(await csv('doppler-azimuth'), 'azimuth_deg,range_rate_mps,range_m,rcs_dbsm,residual_mps,weight');
    assertCsv(await csv('birds-eye'), 'x_m,y_m,range_m,azimuth_deg,rcs_dbsm,weight');
    const frames = assertCsv(
      await csv('frame-weights'),
      'time_s,verdict,detections,inliers,weight_per_rad2,vx_mps,vy_mps,angle_deg,angle_sigma_deg',
    );
    assert.equal(frames.length, 12_003);
    assertCsv(await csv('trajectory'), 'path,time_s,x_m,y_m,yaw_deg');
  },
);

browserTest(
  'mounting angle: results are saved as CSV and JSON, with the options',
  { path: '#/mounting?methods=recursive' },
  async ({ page }) => {
    await ready(page);
    const table = await saved(page, save(results(page), 'CSV'));
    assert.match(
      table.bytes.toString(),
      /^method,angle_deg,sigma_deg,error_deg,converged,misaligned,scale,scale_sigma,bias_degps,/,
    );
    const report = assertJson(await saved(page, save(results(page), 'JSON')));
    assert.equal(report.methods[0].angleDeg, await value(page, 'recursive', 'angleDeg'));
    assert.equal(report.statedDeg, -1.96);
    assert.equal(report.options.minSpeedMps, 3);
    assert.equal(report.drive.counts.dropped['invalid-marker'], 192);
  },
);

browserTest(
  'mounting angle: a report is saved that stands by itself, and its writing can be cancelled',
  { path: '#/mounting?methods=recursive' },
  async ({ page, browser }) => {
    await ready(page);
    const write = save(results(page), 'Report');
    const report = await saved(page, write);
    const html = report.bytes.toString();
    const angle = await value(page, 'recursive', 'angleDeg');
    assert.match(html, /<h1>Mounting angle of radar 1<\/h1>/);
    assert.ok(html.includes(`${angle.toFixed(3)} ± `), html.slice(0, 2000));
    assert.match(html, /front_radar\.csv, as served<\/th><td>\d+ bytes, SHA-256 [0-9a-f]{64}</);
    // As a page of its own it shows the same, and asks for nothing; its policy lets its style pass and no script.
    const apart = await browser.newContext();
    const shown = await apart.newPage();
    const address = 'http://report.invalid/';
    const opened = async (body) => {
      const [answered, blocked] = [[], []];
      shown.removeAllListeners();
      shown.on('response', (response) => answered.push(response.url()));
      shown.on('console', (message) => blocked.push(message.text()));
      await shown.route(address, (route) => route.fulfill({ contentType: 'text/html', body }));
      await shown.goto(address);
      assert.match(await shown.locator('.verdict').innerText(), /^(Pass|Fail|Undecided)/);
      assert.notEqual(await shown.locator('body').evaluate((body) => getComputedStyle(body).maxWidth), 'none');
      assert.deepEqual(answered, [address]);
      return blocked;
    };
    assert.deepEqual(await opened(html), []);
    const injected =
      '<script>document.title = "run"</script><img src="http://report.invalid/x" onerror="document.title = 1">';
    const blocked = await opened(html.replace('</h1>', `</h1>${injected}`));
    assert.ok(
      blocked.some((text) => /inline script/.test(text)) && blocked.some((text) => /image/.test(text)),
      blocked,
    );
    assert.match(await shown.title(), /^Mounting angle/);
    await apart.close();
    await write.click();
    await results(page)
      .getByRole('button', { name: /^Cancel report/ })
      .click();
    await write.waitFor();
    assert.equal(await alert(page).count(), 0);
  },
);

browserTest(
  'mounting angle: where the angle is not settled the page says what to drive next',
  { path: '#/mounting?methods=recursive' },
  async ({ page }) => {
    await ready(page);
    assert.equal(await page.locator('[data-outlook]').count(), 0);
    await typeNumber(control(page, 'spinbutton', 'Settled below σ'), '0.08');
    await page.waitForSelector('[aria-busy="false"] [data-outlook]');
    assert.match(await page.locator('[data-outlook] p').first().innerText(), /^Next\./);
    await page.getByText('What a minute more would bring', { exact: true }).click();
    assert.equal(await page.locator('[data-manoeuvre]').count(), 5);
  },
);
