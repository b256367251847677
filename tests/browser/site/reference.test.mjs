// The API reference as somebody who looks for an option uses it.
import { browserTest } from '../lib/harness.mjs';

browserTest('an option is found from the demo by typing', {}, async ({ page }) => {
  /** Types into the search field, which a key opens once the scripts of the page have run. */
  const search = async (text, option) => {
    await page.waitForLoadState('load');
    await page.keyboard.press('/');
    const field = page.getByRole('combobox');
    await field.waitFor();
    // Text that is typed before the search index is there finds nothing.
    await page.getByText('Preparing search index').waitFor({ state: 'hidden' });
    await field.pressSequentially(text);
    await page.getByRole('option', { name: option }).first().waitFor();
  };
  // What still loads would be broken off by the click.
  await page.waitForLoadState('networkidle');
  await page.getByRole('link', { name: 'API reference' }).click();
  await page.getByRole('heading', { level: 1, name: 'Boresight' }).waitFor();
  await page.getByRole('cell', { name: 'radar plots as custom elements' }).waitFor();
  await search('thresholdDb', /IaaOptions\.thresholdDb/);
  await page
    .getByRole('option', { name: /IaaOptions\.thresholdDb/ })
    .first()
    .click();
  await page.getByText('Threshold below the strongest power (positive) (0 to 300 dB; default 40).').first().waitFor();
  await search('cramerRaoBound', /cramerRaoBound/);
  await page.keyboard.press('ArrowDown');
  await page.keyboard.press('Enter');
  await page.getByRole('heading', { level: 1, name: 'Function cramerRaoBound' }).waitFor();
  await page.locator('code', { hasText: "import { cramerRaoBound, init } from 'boresight';" }).waitFor();
});
