/** Networks: a network beside classical methods on one scene, another scene, and a file that is no network. */
import assert from 'node:assert/strict';
import { browserTest } from '../lib/harness.mjs';
import { cellOf, numberOf } from '../lib/tables.mjs';
import { typeNumber } from '../lib/type.mjs';

browserTest('flow: networks', { path: '#/networks?model=learned-pursuit', timeout: 180_000 }, async ({ page }) => {
  await page.getByRole('button', { name: 'Run on this scene' }).first().click();
  const attempt = page.getByRole('region', { name: /^Try it/ });
  // Six targets are found by the network and by IAA; the FFT shows sidelobes as well.
  const found = async (name, column) => numberOf(await cellOf(attempt, name, column));
  assert.deepEqual([await found('Truth', 0), await found('IAA', 0)], [6, 6]);
  assert.ok((await found('Learned pursuit, form small', 3)) < 2 * (await found('IAA', 3)), 'RMSE');
  assert.ok((await found('Bartlett (FFT)', 2)) > 0, 'false targets of the FFT');
  const targets = page.getByRole('spinbutton', { name: 'Targets' });
  await typeNumber(targets, '2');
  await targets.press('Tab');
  await cellOf(attempt, 'Truth', 0, /^2$/);
});
