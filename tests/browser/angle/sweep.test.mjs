/** Monte-Carlo runs in the angle lab. */
import assert from 'node:assert/strict';
import { control } from '../lib/controls.mjs';
import { assertCsv, clickWhenThere, saved } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { patient } from '../lib/trial.mjs';
import { typeNumber } from '../lib/type.mjs';

const scene = '#/angle?array=ula10&targets=-5:0,12:0&snr=20&snapshots=100&seed=3&methods=bartlett,music';
const HEADER = 'snr_db,crb_deg,bartlett_rmse_deg,bartlett_found,music_rmse_deg,music_found';
const done = (page) => page.waitForSelector('[data-sweep][aria-busy="false"] [data-plot="sweep-found"]', patient);
const panel = (page) => page.getByRole('region', { name: 'Monte Carlo', exact: true });
const field = (page, role, name) => control(panel(page), role, name);
const runButton = (page) => field(page, 'button', 'Run');
const save = (page, plot) =>
  panel(page).getByRole('figure', { name: plot, exact: true }).getByRole('button', { name: 'CSV' });
const run = async (page) => {
  // Looked for from before: few runs may be done soon.
  await Promise.all([field(page, 'button', 'Cancel').waitFor(), runButton(page).click()]);
  await done(page);
};

browserTest(
  'monte carlo: MUSIC follows the bound over SNR, and the FFT does not',
  { path: scene },
  async ({ page }) => {
    await page.waitForSelector('[data-row="music"] [data-field="azimuth"][data-value]');
    await typeNumber(field(page, 'spinbutton', 'From'), '0');
    await run(page);
    const rows = assertCsv(await saved(page, save(page, 'Error')), HEADER).map((row) => row.map(Number));
    assert.equal(rows.length, 11);
    for (const [snr, bound, fft, fftFound, music, found] of rows) {
      assert.equal(found, 1, `all are found at ${snr} dB`);
      assert.equal(fftFound, 1);
      // 400 errors: their root mean square has a standard deviation of 3.5 %; MUSIC is known to be near the bound.
      assert.ok(music > 0.86 * bound && music < 1.25 * bound, `${music} at ${snr} dB, bound ${bound}`);
      if (snr >= 12) assert.ok(fft > 1.5 * bound, 'the FFT is biased by the other target');
    }
    // The bound falls by 10 for 20 dB.
    const [first, last] = [rows[0], rows.at(-1)];
    const slope = Math.log10(first[1] / last[1]) / ((last[0] - first[0]) / 20);
    assert.ok(Math.abs(slope - 1) < 0.05, `slope ${slope}`);
    await typeNumber(page.getByRole('spinbutton', { name: 'SNR' }), '10');
    await page.getByText('The last runs are of other settings').waitFor();
    assert.equal(await page.locator('[data-plot="sweep-error"]').count(), 0);
  },
);

browserTest(
  'monte carlo: nearer than a beam the FFT finds one of two',
  { path: `${scene.replace('-5:0,12:0', '-3:0,3:0')}&sweep=separation&runs=50` },
  async ({ page }) => {
    await page.waitForSelector('[data-row="music"] [data-field="azimuth"][data-value]');
    await run(page);
    const rows = assertCsv(
      await saved(page, save(page, 'Targets found')),
      HEADER.replace('snr_db', 'separation_deg'),
    ).map((row) => row.map(Number));
    for (const [separation, , , fft, , music] of rows) {
      if (separation < 6) assert.equal(fft, 0.5, `one of two at ${separation} degrees`);
      if (separation > 13) assert.equal(fft, 1);
      if (separation > 4) assert.equal(music, 1);
    }
    assert.match(await page.locator('[data-plot="sweep-error"] figcaption').innerText(), /50 runs/);
  },
);

browserTest(
  'monte carlo: it is cancelled, says what it lacks, and goes on',
  { path: `${scene}&runs=5000` },
  async ({ page }) => {
    await page.waitForSelector('[data-row="music"] [data-field="azimuth"][data-value]');
    const bar = clickWhenThere(page, '[data-sweep] .progress-line button');
    await runButton(page).click();
    const { value, max } = await bar;
    assert.ok(value < max);
    await runButton(page).waitFor();
    await panel(page)
      .getByText(/Cancelled/)
      .waitFor();
    await field(page, 'combobox', 'Against').selectOption('separation');
    await page.getByRole('button', { name: 'Remove target 2', exact: true }).click();
    await runButton(page).and(page.locator(':disabled')).waitFor();
    await panel(page)
      .getByText(/takes two targets/)
      .waitFor();
    await field(page, 'combobox', 'Against').selectOption('snapshots');
    await typeNumber(field(page, 'spinbutton', 'Runs'), '20');
    await typeNumber(field(page, 'spinbutton', 'To'), '50');
    await run(page);
    assert.match(await page.locator('[data-plot="sweep-error"] figcaption').innerText(), /1 target, 20 runs/);
  },
);
