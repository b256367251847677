/** Networks that answer with a spectrum, and learning curves, on the page Networks. */
import assert from 'node:assert/strict';
import { assertCsv, saved } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { card, cell, patient } from '../lib/trial.mjs';
import { typeNumber } from '../lib/type.mjs';

const network = (page) => page.getByRole('combobox', { name: 'Network', exact: true });
const csvOf = (page, plot) => saved(page, page.locator(`[data-plot="${plot}"]`).getByRole('button', { name: 'CSV' }));

browserTest(
  'networks: UAA gives its spectrum beside that of IAA, each on its own grid',
  { path: '#/networks?model=unrolled-iaa&targets=3&snr=25&seed=3&run=1' },
  async ({ page }) => {
    await page.waitForSelector('[data-attempt^="lrr48"]', patient);
    const [found] = await cell(page, 'unrolled-iaa', 'found');
    assert.ok(found >= 2, `found ${found} of 3`);
    const csv = await csvOf(page, 'attempt');
    const rows = assertCsv(csv, 'azimuth_deg,unrolled_iaa_db,iaa_db,bartlett_db');
    // The coarse grid is drawn through the points of the fine one, and no further than it goes.
    assert.ok(rows.length > 1000, `${rows.length} rows`);
    const own = rows.filter(([, db]) => db !== '');
    assert.ok(own.length > 0.8 * rows.length && own.length < rows.length, `${own.length} of ${rows.length}`);
  },
);

browserTest(
  'networks: those on a covariance see many snapshots, as methods on it do',
  { path: '#/networks?model=covariance-cnn&targets=2&snr=0&seed=2&run=1' },
  async ({ page }) => {
    for (const name of ['covariance-cnn', 'deep-music']) {
      await network(page).selectOption(name);
      await page.waitForSelector(`[data-attempt^="ula16"] [data-row="${name}"] [data-field="found"]`, patient);
      for (const method of [name, 'music', 'capon']) assert.deepEqual(await cell(page, method, 'found'), [2], method);
      assert.match(await page.locator('[data-attempt]').getAttribute('data-attempt'), /2 targets, 200 snapshots, 0 dB/);
    }
    // Three sources at most; the refused one stays in the field with its reason.
    const field = page.getByRole('spinbutton', { name: 'Targets', exact: true });
    await typeNumber(field, '4');
    await field.and(page.locator('[aria-invalid="true"]')).waitFor();
    await typeNumber(field, '3');
    await page.waitForSelector('[data-attempt^="ula16, 3 targets"]', patient);
  },
);

browserTest(
  'networks: a learning curve is shown with the card',
  { path: '#/networks?model=unrolled-iaa' },
  async ({ page }) => {
    const { learning } = card('unrolled-iaa');
    await page.waitForSelector('[data-plot="learning"] canvas');
    assert.equal(await page.locator('[data-plot="learning"] .legend li').count(), learning.length);
    assertCsv(await csvOf(page, 'learning'), 'run,samples,hours,f1');
    await network(page).selectOption('counting');
    await page.waitForSelector('[data-card="counting"]');
    assert.equal(await page.locator('[data-plot="learning"]').count(), 0);
  },
);
