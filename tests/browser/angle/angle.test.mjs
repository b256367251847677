import assert from 'node:assert/strict';
import { button, control, twoFrames } from '../lib/controls.mjs';
import { assertCsv, assertPng, parameters, parametersWith, reload, saved, values } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { typeNumber, typeText } from '../lib/type.mjs';

const path =
  '#/angle?array=ula10&targets=-5:0,12:0&snr=20&snapshots=100&seed=7&methods=bartlett,capon,music,root-music';
const estimates = (page, method) =>
  values(page, `[data-table="results"] [data-row="${method}"] [data-field="azimuth"]`);
const plotOf = (page, name) => page.getByRole('figure', { name, exact: true });
const spectrumCsv = (page) => saved(page, button(plotOf(page, 'Angle spectrum'), 'CSV'));
const tableCsv = (page) => saved(page, button(control(page, 'region', 'Estimates and errors'), 'CSV'));
/** A target's ring on the plot. */
const ring = (page, number) =>
  plotOf(page, 'Angle spectrum').getByRole('button', { name: `Target ${number}: azimuth` });
const shown = (page, method) => page.waitForSelector(`[data-row="${method}"] [data-field="azimuth"][data-value]`);

browserTest('angle lab: estimates lie within five bounds of the targets', { path }, async ({ page }) => {
  await shown(page, 'root-music');
  const bounds = await values(page, '[data-field="crb"]');
  assert.equal(bounds.length, 2);
  // 20 dB, 100 snapshots, 10 elements: some hundredths of a degree.
  for (const bound of bounds) assert.ok(bound > 0.005 && bound < 0.2, `bound ${bound}`);
  for (const method of ['music', 'root-music']) {
    const errors = await values(page, `[data-row="${method}"] [data-field="error"]`);
    assert.equal(errors.length, 2, method);
    errors.forEach((error, i) =>
      assert.ok(Math.abs(error) < 5 * bounds[i], `${method}: error ${error}, bound ${bounds[i]}`),
    );
  }
});

browserTest('angle lab: dragging a target moves its estimates and the address', { path }, async ({ page }) => {
  await shown(page, 'music');
  const before = await estimates(page, 'music');
  const box = await ring(page, 2).boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  await page.mouse.move(x, y);
  await page.mouse.down();
  await page.mouse.move(x - 60, y + 10, { steps: 5 });
  await page.mouse.move(x - 120, y + 20, { steps: 5 });
  await page.mouse.up();
  const truth = '[data-field="truth"][data-target="1"]';
  await page.waitForFunction((cell) => Number(document.querySelector(cell).dataset.value) > 30, truth);
  await page.waitForFunction((cell) => {
    const [azimuth, power] = new URLSearchParams(location.hash.split('?')[1])
      .get('targets')
      .split(',')[1]
      .split(':')
      .map(Number);
    return azimuth === Number(document.querySelector(cell).dataset.value) && power < 0;
  }, truth);
  const [azimuth] = await values(page, truth);
  await page.waitForFunction((wanted) => {
    const cell = document.querySelector('[data-row="music"] [data-field="azimuth"][data-target="1"]');
    return Math.abs(Number(cell?.dataset.value) - wanted) < 1;
  }, azimuth);
  const after = await estimates(page, 'music');
  assert.ok(Math.abs(after[0] - before[0]) < 1, 'the other target stays');
  assert.ok(Math.abs(after[1] - azimuth) < 1, `estimate ${after[1]} of a target at ${azimuth}`);
});

browserTest('angle lab: the address reproduces the numbers', { path }, async ({ page, context }) => {
  await shown(page, 'music');
  await typeNumber(control(page, 'spinbutton', 'SNR'), '13');
  await typeNumber(control(page, 'spinbutton', 'Elements'), '16');
  await typeNumber(control(page, 'spinbutton', 'Azimuth of target 1, degrees'), '-21.5');
  await parametersWith(
    page,
    (params) =>
      params.get('snr') === '13' && params.get('array') === 'ula16' && params.get('targets').startsWith('-21.5:'),
  );
  await page.waitForFunction(() => document.querySelector('[data-field="truth"]').dataset.value === '-21.5');
  await shown(page, 'root-music');
  const first = await estimates(page, 'root-music');
  const other = await context.newPage();
  await other.goto(page.url());
  await shown(other, 'root-music');
  assert.deepEqual(await estimates(other, 'root-music'), first);
  assert.equal(await control(other, 'spinbutton', 'SNR').inputValue(), '13');
  await reload(page);
  await shown(page, 'root-music');
  assert.deepEqual(await estimates(page, 'root-music'), first);
});

browserTest('angle lab: a target can be moved, added and removed from the keyboard', { path }, async ({ page }) => {
  await shown(page, 'music');
  await ring(page, 1).focus();
  await page.keyboard.press('ArrowLeft');
  await page.keyboard.press('Shift+ArrowLeft');
  await page.keyboard.press('-');
  await parametersWith(page, (params) => params.get('targets') === '-3.9:-0.5,12:0');
  // Plots say it with the next frame.
  await page.getByRole('button', { name: /azimuth −3\.9 degrees, power −0\.5 dB/ }).waitFor();
  await page.keyboard.press('Delete');
  await parametersWith(page, (params) => params.get('targets') === '12:0');
  await ring(page, 2).waitFor({ state: 'detached' });
  const rest = await ring(page, 1).elementHandle();
  // The focus goes there with the next frame.
  await page.waitForFunction((node) => node === focused(), rest);
  await control(page, 'button', 'Add target').focus();
  await page.keyboard.press('Enter');
  await parametersWith(page, (params) => params.get('targets').split(',').length === 2);
});

browserTest('angle lab: double clicks add and remove targets', { path }, async ({ page }) => {
  await shown(page, 'music');
  const plot = await plotOf(page, 'Angle spectrum').locator('.u-over').boundingBox();
  await page.mouse.dblclick(plot.x + plot.width * 0.25, plot.y + plot.height * 0.4);
  await parametersWith(page, (params) => params.get('targets').split(',').length === 3);
  const added = Number(parameters(page).get('targets').split(',')[2].split(':')[0]);
  assert.ok(Math.abs(added - 45) < 1, `added at ${added}`);
  await ring(page, 3).dblclick();
  await parametersWith(page, (params) => params.get('targets') === '-5:0,12:0');
});

browserTest('angle lab: what a method cannot do is said, and a bad position too', { path }, async ({ page }) => {
  await shown(page, 'music');
  const single = control(page, 'checkbox', 'Single-snapshot MUSIC');
  assert.ok(await single.isDisabled());
  assert.match(await page.locator('#method-single-snapshot-music-note').innerText(), /single snapshot/);
  await control(page, 'combobox', 'Virtual array').selectOption('at');
  const positions = control(page, 'textbox', 'Positions, half wavelengths');
  await typeText(positions, '0, 1, x');
  await page
    .getByRole('alert')
    .filter({ hasText: /Element 3/ })
    .waitFor();
  await parametersWith(page, (params) => params.get('array') === 'at:0,1,4,6');
  await typeText(positions, '0, 1, 3.5, 6, 9');
  await parametersWith(page, (params) => params.get('array') === 'at:0,1,3.5,6,9');
  await control(page, 'checkbox', 'ESPRIT').and(page.locator(':disabled')).waitFor();
  assert.match(await page.locator('#method-esprit-note').innerText(), /uniform/);
  // No two of them are one apart, but all stand on a grid of one.
  await typeText(positions, '0, 2, 5');
  await control(page, 'checkbox', 'Root-MUSIC').and(page.locator(':enabled')).waitFor();
  await shown(page, 'root-music');
  await control(page, 'combobox', 'Virtual array').selectOption('awr1843');
  await control(page, 'checkbox', 'Off-grid sparse Bayesian learning').and(page.locator(':disabled')).waitFor();
  assert.match(await page.locator('#method-sparse-bayesian-note').innerText(), /no elevation/);
});

browserTest(
  'angle lab: slow methods answer from a worker',
  { path: path.replace('root-music', 'iaa,nomp,maximum-likelihood,sparse-bayesian') },
  async ({ page }) => {
    for (const method of ['iaa', 'nomp', 'maximum-likelihood', 'sparse-bayesian']) {
      await shown(page, method);
      const errors = await values(page, `[data-row="${method}"] [data-field="error"]`);
      assert.ok(errors.length > 0 && errors.every((error) => Math.abs(error) < 1), `${method}: ${errors}`);
    }
  },
);

browserTest('angle lab: plots and tables are saved as PNG and CSV', { path }, async ({ page }) => {
  await shown(page, 'music');
  const [elements, pattern] = ['Virtual elements', 'Beam pattern at boresight'].map((name) => plotOf(page, name));
  for (const plot of [plotOf(page, 'Angle spectrum'), elements, pattern])
    assertPng(await saved(page, button(plot, 'PNG')));
  const rows = assertCsv(await spectrumCsv(page), 'azimuth_deg,bartlett_db,capon_db,music_db');
  // The grid, and 90 degrees.
  assert.equal(rows.length, 1025);
  assertCsv(
    await saved(page, button(elements, 'CSV')),
    'element,x_half_wavelengths,y_half_wavelengths,z_half_wavelengths,tx,rx',
  );
  assertCsv(await saved(page, button(pattern, 'CSV')), 'azimuth_deg,response_db');
  assertCsv(
    await tableCsv(page),
    'method,target,true_azimuth_deg,true_power_db,azimuth_deg,error_deg,power_db,stated_sigma_deg,crb_sigma_deg,time_ms',
  );
});

browserTest('angle lab: a drag zooms, the cursor reads out, a key resets', { path }, async ({ page }) => {
  await shown(page, 'music');
  const plot = plotOf(page, 'Angle spectrum');
  const over = await plot.locator('.u-over').boundingBox();
  const label = async () => {
    await twoFrames(page);
    return plot.locator('.readout').innerText();
  };
  await page.mouse.move(over.x + over.width / 2, over.y + over.height / 2);
  // A pixel is 0.2 dB, and the middle may lie between two.
  assert.match(await label(), /Azimuth [+−]?0\.\d\d°\s+Level −1(7\.9|8\.[01])/);
  await page.mouse.move(over.x + over.width * 0.5, over.y + 200);
  await page.mouse.down();
  await page.mouse.move(over.x + over.width * 0.25, over.y + 205, { steps: 5 });
  await page.mouse.up();
  await page.mouse.move(over.x + over.width / 2, over.y + over.height / 2);
  assert.match(await label(), /Azimuth \+22\.\d\d°/);
  await plot.getByRole('application').press('0');
  await page.mouse.move(over.x + over.width / 2 + 1, over.y + over.height / 2);
  assert.match(await label(), /Azimuth [+−]?0\.\d\d°/);
});

browserTest(
  'angle lab: the table’s file has the estimates that belong to no target',
  { path: '#/angle?array=ula10&targets=-3:0,3:0&snr=20&snapshots=100&seed=1&methods=bartlett,music' },
  async ({ page }) => {
    await shown(page, 'music');
    const extra = Number(await page.locator('[data-row="bartlett"] td[title]').last().innerText());
    assert.ok(extra >= 1, `${extra} beside the targets`);
    const rows = assertCsv(
      await tableCsv(page),
      'method,target,true_azimuth_deg,true_power_db,azimuth_deg,error_deg,power_db,stated_sigma_deg,crb_sigma_deg,time_ms',
    );
    const beside = rows.filter(([method, target]) => method === 'bartlett' && target === '');
    assert.equal(beside.length, extra);
    for (const [, , , , azimuth, error] of beside) assert.ok(Number.isFinite(Number(azimuth)) && error === '');
    assert.equal(rows.filter(([method]) => method === 'music').length, 2);
  },
);

browserTest('angle lab: without targets the spectra are of noise', { path }, async ({ page }) => {
  await shown(page, 'music');
  for (let left = 2; left > 0; left--) await control(page, 'button', 'Remove target 1').click();
  await parametersWith(page, (params) => params.get('targets') === '-');
  for (const method of ['bartlett', 'capon'])
    assert.doesNotMatch(await page.locator(`[data-row="${method}"]`).innerText(), /expected/);
  const rows = assertCsv(await spectrumCsv(page), 'azimuth_deg,bartlett_db,capon_db');
  const levels = rows.map(([, bartlett]) => Number(bartlett));
  // Noise is 20 dB down at one element, 30 dB over ten; 100 snapshots leave a spread of 10 %, so 2 dB are five of them.
  assert.ok(
    levels.every((level) => Math.abs(level + 30) < 2),
    `${Math.min(...levels)} to ${Math.max(...levels)} dB`,
  );
});

browserTest(
  'angle lab: spectra reach 90 degrees where they are there what they are at -90',
  { path: '#/angle?array=ula10&targets=-5:0&snr=20&snapshots=100&seed=1&methods=bartlett,music' },
  async ({ page }) => {
    await shown(page, 'music');
    const csv = async () =>
      assertCsv(await spectrumCsv(page), 'azimuth_deg,bartlett_db,music_db').map((row) => row.map(Number));
    const whole = await csv();
    assert.deepEqual(whole.at(-1), [90, ...whole[0].slice(1)]);
    await control(page, 'combobox', 'Virtual array').selectOption('at');
    await typeText(control(page, 'textbox', 'Positions, half wavelengths'), '0, 1.3, 2.9, 4.1');
    await parametersWith(page, (params) => params.get('array') === 'at:0,1.3,2.9,4.1');
    await page.waitForFunction(() => /at|positions/.test(within('[data-plot="spectrum"]', 'figcaption').innerText));
    assert.ok((await csv()).at(-1)[0] < 89);
  },
);
