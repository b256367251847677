/** Mounting angle: the verdict on a recorded drive, its moments, and a simulated drive with a known angle. */
import assert from 'node:assert/strict';
import { saved } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { cellOf, numberOf } from '../lib/tables.mjs';

browserTest('flow: mounting angle', { path: '#/mounting', timeout: 180_000 }, async ({ page }) => {
  // The data set states -1.96 degrees.
  const verdict = page.getByRole('region', { name: 'Verdict' }).getByRole('status');
  await verdict.filter({ hasText: /−2\.02° ± 0\.09°: misaligned/ }).waitFor({ timeout: 90_000 });
  const [angle, sigma] = [0, 1].map((column) => cellOf(page, 'Recursive robust likelihood', column));
  assert.ok(Math.abs(numberOf(await angle) + 1.96) < 2 * numberOf(await sigma));
  const file = await saved(page, page.getByRole('button', { name: 'JSON', exact: true }));
  const [radar] = [JSON.parse(file.bytes)].flat();
  assert.ok(JSON.stringify(radar).includes('-2.02'), 'the file has the angle of the page');

  const time = page.getByRole('slider', { name: 'Time' });
  const before = await time.inputValue();
  await time.press('ArrowRight');
  await page.waitForFunction(([old]) => document.activeElement.value !== old, [before]);

  await page.getByRole('link', { name: 'City' }).click();
  await verdict.filter({ hasText: /±/ }).waitFor({ timeout: 120_000 });
  const [found, deviation] = [0, 2].map((column) => cellOf(page, 'Recursive robust likelihood', column, /\d/));
  await found;
  // The error against the truth, which a simulated drive has.
  assert.ok(Math.abs(numberOf(await deviation)) < 0.3, `off by ${await deviation}`);
});
