/** Two settings of a page beside each other. */
import assert from 'node:assert/strict';
import { button, combobox, figure, spinbutton } from '../lib/controls.mjs';
import { assertCsv, parameters, parametersWith, saved, values } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { leave, typeNumber } from '../lib/type.mjs';
import { later } from '../state/undo.mjs';
import { ready } from './page.mjs';

const path = '#/angle?array=ula10&targets=-5:0,12:0&snr=20&snapshots=100&seed=1&methods=bartlett,music,root-music';
const shown = (page) => page.waitForSelector('[data-row="music"] [data-field="azimuth"][data-value]');
const table = '[data-table="compare"]';
const press = (page, name) => button(page, name).click();
/** Text of A and B in each setting that differs. */
const settings = (page) =>
  page
    .locator(`${table} [data-setting]`)
    .evaluateAll((rows) =>
      rows.map((row) => [row.dataset.setting, ...[...row.children].map((cell) => cell.innerText)]),
    );
const error = (page, method, which) => values(page, `${table} [data-row="${method}"] [data-field="rms-${which}"]`);
const computed = (page, method, which) =>
  page.waitForSelector(`${table} [data-row="${method}"] [data-field="rms-${which}"][data-value]`);
const rmsShown = async (page, method) => {
  const errors = await values(page, `[data-table="results"] [data-row="${method}"] [data-field="error"]`);
  return Math.sqrt(errors.reduce((sum, value) => sum + value * value, 0) / errors.length);
};
const near = (a, b) => assert.ok(Math.abs(a - b) < 1e-12, `${a} is ${b}`);

async function typeSnr(page, text) {
  const field = spinbutton(page, 'SNR');
  await typeNumber(field, text);
  await leave(field);
  await parametersWith(page, (params) => params.get('snr') === text);
}

browserTest('compare: what is kept as A stays while B changes, is swapped and dropped', { path }, async ({ page }) => {
  await shown(page);
  const errorOfA = await rmsShown(page, 'root-music');
  await press(page, 'Keep as A');
  await computed(page, 'root-music', 'a');
  assert.deepEqual(await settings(page), [], 'A is B at first');
  near((await error(page, 'root-music', 'a'))[0], errorOfA);
  near((await error(page, 'root-music', 'difference'))[0], 0);

  await typeSnr(page, '5');
  await page.waitForSelector(`${table} [data-setting="snr"]`);
  assert.deepEqual(await settings(page), [['snr', 'SNR (dB)', '20', '5']]);
  await page.waitForFunction((wanted) => {
    const cell = document.querySelector('[data-table="compare"] [data-row="root-music"] [data-field="rms-b"]');
    return cell?.dataset.value !== undefined && Number(cell.dataset.value) !== wanted;
  }, errorOfA);
  const errorOfB = await rmsShown(page, 'root-music');
  near((await error(page, 'root-music', 'a'))[0], errorOfA);
  near((await error(page, 'root-music', 'b'))[0], errorOfB);
  near((await error(page, 'root-music', 'difference'))[0], errorOfB - errorOfA);
  const [boundA] = await error(page, 'bound', 'a');
  const [boundB] = await error(page, 'bound', 'b');
  assert.ok(boundB > 5 * boundA, 'at 15 dB less the bound is wider');
  const plot = figure(page, 'Angle spectrum');
  for (const id of ['bartlett-a', 'music-a', 'root-music-a'])
    assert.equal(await plot.locator(`[data-series="${id}"]`).count(), 1, id);

  // Both curves are in the numbers and in the pictures.
  const rows = assertCsv(
    await saved(page, button(plot, 'CSV')),
    'azimuth_deg,bartlett_db,music_db,bartlett_a_db,music_a_db',
  );
  assert.ok(rows.some(([, b, , a]) => Math.abs(Number(a) - Number(b)) > 3));
  const svg = (await saved(page, button(plot, 'SVG'))).bytes.toString('utf8');
  assert.match(svg, /A, dashed: SNR \(dB\) 20/);
  assert.equal(
    (
      svg.match(
        /<path[^>]*stroke-dasharray="8,8"[^>]*stroke-opacity="0\.6"|<path[^>]*stroke-opacity="0\.6"[^>]*stroke-dasharray="8,8"/g,
      ) ?? []
    ).length >= 2,
    true,
    'A is dashed and faint',
  );

  // Changes near to each other are one to Undo.
  await later(page);
  await press(page, 'Swap');
  await parametersWith(page, (params) => params.get('snr') === '20');
  await page.waitForFunction(() => document.querySelector('[data-setting="snr"]')?.textContent.includes('520'));
  await page.keyboard.press('Control+z');
  await parametersWith(page, (params) => params.get('snr') === '5');
  await button(page, 'Drop A').press('Enter');
  await parametersWith(page, (params) => !params.has('a') && params.get('snr') === '5');
  assert.equal(await page.locator(table).count(), 0);
  assert.equal(await plot.locator('[data-series="music-a"]').count(), 0);
});

browserTest('compare: a link brings both', { path, viewport: 'phone' }, async ({ page, context, url }) => {
  await shown(page);
  await button(page, 'Keep as A').tap();
  await parametersWith(page, (params) => params.get('a')?.includes('snr=20'));
  const a = 'array=ula12&targets=-8:0&snr=3&snapshots=20&seed=4&methods=capon';
  const other = await context.newPage();
  await other.goto(`${url}${path}&a=${encodeURIComponent(a)}`);
  await shown(other);
  await computed(other, 'capon', 'a');
  assert.equal(parameters(other).get('a'), a);
  const rows = new Map((await settings(other)).map(([key, , ...both]) => [key, both]));
  assert.deepEqual(rows.get('array'), ['ula12', 'ula10']);
  assert.deepEqual(rows.get('targets'), ['-8:0', '-5:0, 12:0']);
  assert.deepEqual(rows.get('methods'), ['capon', 'bartlett, music, root-music']);
  assert.equal((await error(other, 'capon', 'b')).length, 0, 'B has no Capon');
  assert.equal((await error(other, 'music', 'a')).length, 0, 'and A no MUSIC');
  assert.equal(await other.locator('[data-notice]').count(), 0);
  await other.goto(`${url}${path}&a=${encodeURIComponent('snr=abc&seed=2')}`);
  await other.waitForSelector('[data-notice="link"]');
  assert.match(await other.locator('[data-notice="link"]').innerText(), /“A: snr=abc” was not understood/);
});

browserTest('compare: two chains on one capture', { path: '#/capture' }, async ({ page, context }) => {
  const measured = async (one, id) =>
    Object.fromEntries(
      await one
        .locator(`${table} [data-row="${id}"] [data-field]`)
        .evaluateAll((cells) => cells.map(({ dataset }) => [dataset.field, Number(dataset.value)])),
    );
  const there = (one) => one.waitForSelector(`${table} [data-row="detections"]`);
  await ready(page);
  await press(page, 'Keep as A');
  await there(page);
  const before = await measured(page, 'detections');
  assert.equal(before.a, before.b);
  assert.equal(before.b, await page.locator('[data-table="detections"] tbody tr.pick').count());
  await combobox(page, 'Range window').selectOption('blackman');
  await combobox(page, 'Range padding').selectOption('2');
  await page.waitForFunction((rows) => {
    const cell = (field) => document.querySelector(`${rows} [data-row="bins"] [data-field="${field}"]`)?.dataset.value;
    return Number(cell('b')) === 2 * Number(cell('a'));
  }, table);
  assert.deepEqual(
    (await settings(page)).map(([key, , ...both]) => [key, ...both]),
    [
      ['window', 'hann', 'blackman'],
      ['rangePadding', '1', '2'],
    ],
  );
  assert.equal((await measured(page, 'detections')).a, before.a, 'A stays');
  const plot = figure(page, 'Range profile');
  assert.equal(await plot.locator('[data-series="a"]').count(), 1);
  const svg = (await saved(page, button(plot, 'SVG'))).bytes.toString('utf8');
  assert.match(svg, /stroke-dasharray="8,8"/);
  assert.match(svg, /A, dashed: /);
  await parametersWith(page, (params) => params.has('a') && params.get('window') === 'blackman');
  const other = await context.newPage();
  await other.goto(page.url());
  await ready(other);
  await there(other);
  assert.deepEqual(await measured(other, 'peak'), await measured(page, 'peak'));
  await press(page, 'Swap');
  await parametersWith(page, (params) => !params.has('window'));
  await press(page, 'Drop A');
  await parametersWith(page, (params) => !params.has('a'));
  assert.equal(await plot.locator('[data-series="a"]').count(), 0);
});
