/** Undo, redo and links. */
import assert from 'node:assert/strict';
import { parametersWith } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { leave, typeNumber } from '../lib/type.mjs';

const shown = (page) => page.waitForSelector('[data-row="music"] [data-field="azimuth"][data-value]');
const snr = (page, value) => parametersWith(page, (params) => params.get('snr') === value);

browserTest(
  'history: changes are taken back and made again, by buttons and keys',
  { path: '#/angle' },
  async ({ page }) => {
    await shown(page);
    const button = (name) => page.locator(`[data-action="${name}"]`);
    assert.ok(await button('undo').isDisabled(), 'nothing was changed yet');
    await typeNumber(page.locator('input[name="snr"]'), '13.5');
    await leave(page.locator('input[name="snr"]'));
    await snr(page, '13.5');
    await page.waitForTimeout(900);
    await page.locator('[data-action="add-target"]').click();
    await parametersWith(page, (params) => params.get('targets').split(',').length === 3);
    await button('undo').click();
    await parametersWith(page, (params) => params.get('targets').split(',').length === 2);
    await snr(page, '13.5');
    await page.keyboard.press('Control+z');
    await snr(page, '20');
    assert.ok(await button('undo').isDisabled(), 'the keys of a number are one change');
    await page.keyboard.press('Control+Shift+z');
    await snr(page, '13.5');
    await button('redo').click();
    await parametersWith(page, (params) => params.get('targets').split(',').length === 3);
    assert.ok(await button('redo').isDisabled());
    // Defaults wipe a scene: that is taken back, too.
    await page.getByRole('button', { name: 'Defaults' }).click();
    await snr(page, '20');
    await button('undo').click();
    await snr(page, '13.5');
    await parametersWith(page, (params) => params.get('targets').split(',').length === 3);
  },
);

browserTest('history: undo in a text field is the field’s own', { path: '#/angle' }, async ({ page }) => {
  await shown(page);
  await page.locator('[data-action="add-target"]').click();
  await parametersWith(page, (params) => params.get('targets').split(',').length === 3);
  const field = page.locator('input[name="snr"]');
  await field.click();
  await page.keyboard.press('Control+z');
  await page.waitForTimeout(300);
  assert.equal(new URLSearchParams(new URL(page.url()).hash.split('?')[1]).get('targets').split(',').length, 3);
});

browserTest(
  'history: a copied link shows the same, before the address bar has it',
  { path: '#/angle', permissions: ['clipboard-read', 'clipboard-write'] },
  async ({ page }) => {
    await shown(page);
    await page.locator('select[name="fluctuation"]').selectOption('coherent');
    await page.locator('[data-action="copy-link"]').click();
    await page.waitForFunction(() => /Copied/.test(document.querySelector('[data-action="copy-link"]').textContent));
    const link = await page.evaluate(() => navigator.clipboard.readText());
    assert.match(link, /#\/angle\?.*fluctuation=coherent/);
    await page.goto('about:blank');
    await page.goto(link);
    await shown(page);
    assert.equal(await page.locator('select[name="fluctuation"]').inputValue(), 'coherent');
  },
);
