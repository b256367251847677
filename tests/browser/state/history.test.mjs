/** Undo, redo and links. */
import assert from 'node:assert/strict';
import { button, combobox, spinbutton } from '../lib/controls.mjs';
import { parameters, parametersWith } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { leave, typeNumber } from '../lib/type.mjs';
import { later } from './undo.mjs';

const shown = (page) => page.waitForSelector('[data-row="music"] [data-field="azimuth"][data-value]');
const snr = (page, value) => parametersWith(page, (params) => params.get('snr') === value);
const targets = (page, count) => parametersWith(page, (params) => params.get('targets').split(',').length === count);
const snrField = (page) => spinbutton(page, 'SNR');

browserTest(
  'history: changes are taken back and made again, by buttons and keys',
  { path: '#/angle' },
  async ({ page }) => {
    await shown(page);
    const [undo, redo] = ['Undo', 'Redo'].map((name) => button(page, name));
    assert.ok(await undo.isDisabled(), 'nothing was changed yet');
    await typeNumber(snrField(page), '13.5');
    await leave(snrField(page));
    await snr(page, '13.5');
    await later(page);
    await button(page, 'Add target').click();
    await targets(page, 3);
    await undo.click();
    await targets(page, 2);
    await snr(page, '13.5');
    await page.keyboard.press('Control+z');
    await snr(page, '20');
    assert.ok(await undo.isDisabled(), 'the keys of a number are one change');
    await page.keyboard.press('Control+Shift+z');
    await snr(page, '13.5');
    await redo.click();
    await targets(page, 3);
    assert.ok(await redo.isDisabled());
    // Defaults wipe a scene: that is taken back, too.
    await button(page, 'Defaults').click();
    await snr(page, '20');
    await undo.click();
    await snr(page, '13.5');
    await targets(page, 3);
  },
);

browserTest('history: undo in a text field is the field’s own', { path: '#/angle' }, async ({ page }) => {
  await shown(page);
  await button(page, 'Add target').click();
  await targets(page, 3);
  await snrField(page).click();
  await page.keyboard.press('Control+z');
  // What comes into the address after it.
  await page.keyboard.press('ArrowUp');
  await snr(page, '21');
  assert.equal(parameters(page).get('targets').split(',').length, 3);
});

browserTest(
  'history: a copied link shows the same, before the address bar has it',
  { path: '#/angle', permissions: ['clipboard-read', 'clipboard-write'] },
  async ({ page }) => {
    await shown(page);
    await combobox(page, 'Targets').selectOption('coherent');
    await button(page, 'Copy link').click();
    await button(page, 'Copied').waitFor();
    const link = await page.evaluate(() => navigator.clipboard.readText());
    assert.match(link, /#\/angle\?.*fluctuation=coherent/);
    await page.goto('about:blank');
    await page.goto(link);
    await shown(page);
    assert.equal(await combobox(page, 'Targets').inputValue(), 'coherent');
  },
);
