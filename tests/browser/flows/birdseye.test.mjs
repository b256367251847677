/** Bird's-eye view: images of a street by three methods, radars switched off, another reach. */
import assert from 'node:assert/strict';
import { browserTest } from '../lib/harness.mjs';
import { cellOf, numberOf, row } from '../lib/tables.mjs';
import { typeNumber } from '../lib/type.mjs';

browserTest('flow: bird’s-eye view', { path: '#/birdseye', timeout: 180_000 }, async ({ page }) => {
  const [fft, iaa] = [await cellOf(page, 'Bartlett (FFT)', 0), await cellOf(page, 'IAA', 0)].map(numberOf);
  assert.ok(iaa < fft - 15, `energy outside true points: FFT ${fft} dB, IAA ${iaa} dB`);
  for (const name of ['Bartlett (FFT)', 'IAA', 'NOMP']) await page.getByRole('figure', { name, exact: true }).waitFor();
  const image = page.getByRole('figure', { name: 'IAA', exact: true });
  await image.getByText(/78 m ahead by 48 m across/).waitFor();
  assert.equal(numberOf(await cellOf(page, 'IAA', 4)), 1210);
  await page.getByRole('checkbox', { name: 'left', exact: true }).uncheck();
  // Without the 292 cells of that radar.
  await cellOf(page, 'IAA', 4, /^918$/);
  await row(page, 'Left').waitFor({ state: 'detached' });
  const reach = page.getByRole('spinbutton', { name: 'Reach' });
  await typeNumber(reach, '30');
  await reach.press('Tab');
  await image.getByText(/\b(3\d|4\d) m ahead/).waitFor({ timeout: 60_000 });
});
