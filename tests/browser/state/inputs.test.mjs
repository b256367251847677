/** Results stand only beside the inputs they were computed from, in tables, plots and files. */
import assert from 'node:assert/strict';
import { cells } from '../capture/page.mjs';
import { button, checkbox, combobox, figure, region, spinbutton } from '../lib/controls.mjs';
import { assertJson, saved, values } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { cell, patient, tried } from '../lib/trial.mjs';
import { typeNumber } from '../lib/type.mjs';

/** Keeps what the page sends to its workers, until that is released: the slowest machine there is. */
const hold = (page) =>
  page.evaluate(() => {
    const { postMessage } = Worker.prototype;
    const kept = [];
    Worker.prototype.postMessage = function (...message) {
      kept.push(() => postMessage.apply(this, message));
    };
    window.release = () => {
      Worker.prototype.postMessage = postMessage;
      for (const send of kept.splice(0)) send();
    };
  });
const release = (page) => page.evaluate(() => window.release());

const RESULTS = '[data-table="results"]';
const csvOf = async (page, table) => {
  const { bytes } = await saved(page, button(page.locator(table), 'CSV'));
  return bytes.toString('utf8').trim().split('\n').slice(1);
};
const azimuth = (page) => spinbutton(page, 'Azimuth of target 1, degrees');
const row = (table, method) => `${table} [data-row="${method}"]`;

browserTest(
  'inputs: in the angle lab no estimate of a slow method stands beside a target that has moved',
  {
    path: '#/angle?array=ula32&targets=-5:0,12:0&snr=20&snapshots=100&seed=3&grid=4096&methods=music,iaa,sparse-bayesian',
  },
  async ({ page }) => {
    // This takes hundreds of milliseconds; IAA may be quick enough to run in the page.
    const slow = ['sparse-bayesian'];
    const found = (method) => `${row(RESULTS, method)} [data-field="error"][data-target="0"][data-value]`;
    for (const method of slow) await page.waitForSelector(found(method));
    await hold(page);
    await typeNumber(azimuth(page), '-7');
    await page.waitForSelector('[data-field="truth"][data-target="0"][data-value="-7"]');
    for (const method of slow) {
      await page.waitForSelector(`${row(RESULTS, method)}[aria-busy="true"]`);
      assert.deepEqual(await values(page, `${row(RESULTS, method)} [data-field="azimuth"]`), [], method);
    }
    const lines = await csvOf(page, RESULTS);
    assert.ok(lines.length >= 2);
    for (const line of lines) {
      const [method, , truth, , azimuth] = line.split(',');
      assert.ok(!slow.includes(method) && Math.abs(azimuth - truth) < 0.5, line);
    }
    const spectra = await saved(page, button(figure(page, 'Angle spectrum'), 'CSV'));
    assert.doesNotMatch(spectra.bytes.toString('utf8').split('\n')[0], /sparse_bayesian/);
    await release(page);
    for (const method of slow) {
      await page.waitForSelector(found(method));
      const [error] = await values(page, found(method));
      assert.ok(Math.abs(error) < 0.5, `${method} is off by ${error} degrees`);
    }
  },
);

browserTest(
  'inputs: Monte-Carlo curves are hidden while the settings are others, and are there again when these are',
  { path: '#/angle?array=ula10&targets=-5:0,12:0&snr=20&snapshots=20&seed=3&methods=music&runs=10' },
  async ({ page }) => {
    await page.waitForSelector(`${row(RESULTS, 'music')} [data-field="error"][data-value]`);
    const plot = page.locator('[data-plot="sweep-error"]');
    await button(region(page, 'Monte Carlo'), 'Run').click();
    await page.waitForSelector('[data-sweep][aria-busy="false"] [data-plot="sweep-error"]', patient);
    await typeNumber(azimuth(page), '-7');
    await page.getByText('The last runs are of other settings').waitFor();
    assert.equal(await plot.count(), 0);
    await button(page, 'Undo').click();
    await plot.waitFor();
  },
);

browserTest(
  'inputs: on Capture no estimate of a cell stands under another',
  { path: '#/capture?methods=bartlett,capon&frame=all' },
  async ({ page }) => {
    const found = `${row('[data-table="cell"]', 'bartlett')} [data-field="azimuth"][data-value]`;
    await page.waitForSelector(found);
    await hold(page);
    await cells(page).nth(2).click();
    await page.waitForSelector(`${row('[data-table="cell"]', 'bartlett')}[aria-busy="true"]`);
    assert.equal(await page.locator(found).count(), 0);
    await release(page);
    await page.waitForSelector(found);
  },
);

browserTest(
  'inputs: on Mounting no angle stands under options that it was not found with, and none is exported so',
  { path: '#/mounting?methods=least-squares' },
  async ({ page }) => {
    const found = `${row(RESULTS, 'least-squares')} [data-field="angleDeg"][data-value]`;
    await page.waitForSelector(found, patient);
    await hold(page);
    await typeNumber(spinbutton(page, 'Slowest'), '10');
    await page.waitForSelector(`${row(RESULTS, 'least-squares')}[aria-busy="true"]`);
    assert.equal(await page.locator(found).count(), 0);
    const { options, methods } = assertJson(await saved(page, button(page.locator(RESULTS), 'JSON')));
    assert.equal(options.minSpeedMps ?? options.minSpeed, 10);
    assert.deepEqual(methods, []);
    assert.deepEqual(await csvOf(page, RESULTS), []);
    await release(page);
    await page.waitForSelector(found, patient);
  },
);

browserTest(
  'inputs: on Bird’s-eye no measure stands beside settings of another image; a method more leaves the others',
  { path: '#/birdseye?methods=bartlett&radars=front-left&cell=0.5' },
  async ({ page }) => {
    const found = (method) => `${row(RESULTS, method)} [data-field="cells"][data-value]`;
    await page.waitForSelector(found('bartlett'), patient);
    await hold(page);
    await checkbox(page, 'NOMP').check();
    await page.waitForSelector(`${RESULTS} [data-row][aria-busy="true"]`);
    assert.equal(await page.locator(found('bartlett')).count(), 1, 'the image that is there stays');
    await combobox(page, 'Cell').selectOption('0.2');
    await page.waitForSelector(`${row(RESULTS, 'bartlett')}[aria-busy="true"]`);
    assert.equal(await page.locator(found('bartlett')).count(), 0);
    assert.deepEqual(await csvOf(page, RESULTS), []);
    await release(page);
    await page.waitForSelector(found('bartlett'), patient);
  },
);

browserTest(
  'inputs: the bundled drive has one verdict, on Mounting and on Elements',
  { path: '#/mounting?methods=least-squares' },
  async ({ page }) => {
    await page.waitForSelector(`${row(RESULTS, 'least-squares')} [data-field="misaligned"]`, patient);
    const verdict = await page.locator('[data-verdict]').getAttribute('data-verdict');
    const [angle] = await values(page, `${row(RESULTS, 'least-squares')} [data-field="angleDeg"]`);
    await page.goto(`${page.url().split('#')[0]}#/elements?element=boresight-drive`);
    const element = page.locator('boresight-drive');
    await element
      .getByText(/tolerance$/)
      .first()
      .waitFor(patient);
    const { alarm, found, xM } = await element.evaluate((one) => ({
      alarm: one.alarm,
      found: one.calibration.result.angleDeg,
      xM: one.calibration.mounting.xM,
    }));
    assert.equal({ pass: 'good', fail: 'off', undecided: 'open' }[alarm], verdict);
    assert.ok(Math.abs(found - angle) < 1e-9, `${found} and ${angle} degrees`);
    assert.equal(xM, 3.4);
  },
);

browserTest(
  'inputs: on Networks no attempt stands under another scene, and times are medians of warm calls',
  { path: '#/networks?model=learned-pursuit&targets=3&snr=25&seed=3&run=1' },
  async ({ page }) => {
    await tried(page);
    const table = page.locator('[data-table="attempt"]');
    const [first] = await cell(page, 'bartlett', 'time');
    assert.ok(first > 0);
    assert.match(
      await table.getByRole('columnheader', { name: 'Median time' }).getAttribute('title'),
      /median of at least 3/,
    );
    for (const method of ['learned-pursuit', 'iaa', 'bartlett'])
      assert.match(
        await page.locator(`${row('[data-table="attempt"]', method)} [data-field="time"]`).getAttribute('title'),
        /^([3-9]|\d\d) calls$/,
        method,
      );
    await hold(page);
    await typeNumber(spinbutton(page, 'Seed'), '4');
    await table.waitFor({ state: 'detached' });
    await release(page);
    await page.waitForSelector('[data-attempt*="seed 4"]', patient);
    assert.doesNotMatch(await table.innerText(), /–\sm?s\b/);
  },
);
