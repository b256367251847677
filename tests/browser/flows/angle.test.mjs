/** Angle lab: moving a target changes estimates and plot; errors over SNR are measured and can be cancelled. */
import assert from 'node:assert/strict';
import { assertCsv, saved } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { cellOf, numberOf, row } from '../lib/tables.mjs';
import { typeNumber } from '../lib/type.mjs';

browserTest('flow: angle lab', { path: '#/angle' }, async ({ page }) => {
  for (const method of ['Bartlett (FFT)', 'Capon (MVDR)', 'MUSIC', 'Root-MUSIC']) {
    assert.ok(Math.abs(numberOf(await cellOf(page, method, 0)) + 5) < 0.1, method);
    assert.ok(Math.abs(numberOf(await cellOf(page, method, 3)) - 12) < 0.1, method);
  }
  const azimuth = page.getByRole('spinbutton', { name: 'Azimuth of target 1, degrees' });
  await typeNumber(azimuth, '-20');
  await azimuth.press('Tab');
  await cellOf(page, 'MUSIC', 0, /^−(19\.9|20\.0)/);

  // The horizontal axis is azimuth in degrees: the spectrum is highest where the targets are.
  const plot = page.getByRole('figure', { name: 'Angle spectrum' });
  const csv = await saved(page, plot.getByRole('button', { name: 'CSV' }));
  const rows = assertCsv(csv, 'azimuth_deg,bartlett_db,capon_db,music_db');
  const [best] = rows.reduce((a, b) => (Number(b[3]) > Number(a[3]) ? b : a));
  assert.ok(
    [-20, 12].some((truth) => Math.abs(Number(best) - truth) < 0.5),
    `the highest point is at ${best}`,
  );

  const iaa = page.getByRole('checkbox', { name: 'IAA', exact: true });
  await iaa.check();
  await cellOf(page, 'IAA', 0, /^−(19\.9|20\.0)/);
  await iaa.uncheck();
  await row(page, 'IAA').waitFor({ state: 'detached' });

  const sweep = page.getByRole('region', { name: 'Monte Carlo' });
  const runs = sweep.getByRole('spinbutton', { name: 'Runs' });
  const start = sweep.getByRole('button', { name: 'Run' });
  await typeNumber(runs, '5000');
  await start.click();
  await sweep.getByRole('button', { name: 'Cancel' }).click();
  await sweep.getByText(/Cancelled/).waitFor();
  await typeNumber(runs, '20');
  await start.click();
  await sweep
    .getByText(/20 runs/)
    .first()
    .waitFor();
});
