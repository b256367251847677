/** Elements: one of them live, one of its options changed, and its code. */
import assert from 'node:assert/strict';
import { browserTest } from '../lib/harness.mjs';

browserTest('flow: elements', { path: '#/elements' }, async ({ page }) => {
  const element = page.locator('boresight-spectrum');
  await element.getByRole('application').waitFor();
  await page.getByRole('combobox', { name: 'Method', exact: true }).selectOption('capon');
  await page
    .getByText(/method: 'capon'/)
    .first()
    .waitFor();
  await page.getByRole('link', { name: 'Point cloud' }).click();
  await page.locator('boresight-point-cloud').getByRole('application').waitFor();
  assert.equal(await element.count(), 0);
});
