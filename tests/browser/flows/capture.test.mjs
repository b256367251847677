/** Capture: the bundled recording, one of its cells, other settings, and files of one's own. */
import assert from 'node:assert/strict';
import { drop, recording } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { cellOf, numberOf, row } from '../lib/tables.mjs';

browserTest('flow: capture', { path: '#/capture' }, async ({ page }) => {
  assert.ok(Math.abs(numberOf(await cellOf(page, 'IAA', 0)) + 11.2) < 0.1);
  const map = page.getByRole('figure', { name: 'Range-Doppler map' });
  await map.getByText(/Detection at 2\.95\sm/).waitFor({ state: 'attached' });
  // N goes to another detection, and its angles are shown.
  const cell = page.getByRole('status').filter({ hasText: /^Cell at/ });
  await cell.filter({ hasText: /2\.95\sm/ }).waitFor();
  await map.getByRole('application').press('n');
  await cell.filter({ hasNotText: /2\.95\sm/, hasText: 'A detection' }).waitFor();

  const frames = page.getByRole('region', { name: 'Frames', exact: true });
  await frames.getByRole('button', { name: 'Play' }).click();
  await frames.getByRole('button', { name: 'Pause' }).click();
  await page.getByRole('checkbox', { name: 'NOMP', exact: true }).check();
  await cellOf(page, 'NOMP', 0);
  await page.getByRole('checkbox', { name: 'NOMP', exact: true }).uncheck();
  await row(page, 'NOMP').waitFor({ state: 'detached' });

  // Twice the slope, half the range of each cell.
  const cfg = recording('profile.cfg').toString().replace('57.14 0 0 60 1', '57.14 0 0 30 1');
  await drop(page, [
    { name: 'own.bin', bytes: recording('xwr16xx_crw_dca_module_2018_1015v2.bin') },
    { name: 'own.cfg', bytes: Buffer.from(cfg) },
  ]);
  await page.getByRole('list', { name: 'Open files' }).getByText('own.bin').waitFor();
  await page.getByText(/10\.2\scm/).waitFor();
  await drop(page, [{ name: 'own.cfg', bytes: Buffer.from(cfg.replace('profileCfg 0 77', 'profileCfg 0 x')) }]);
  const alert = page.getByRole('alert');
  await alert.filter({ hasText: /own\.cfg.*profileCfg.*"?x"?; expected/s }).waitFor();
});
