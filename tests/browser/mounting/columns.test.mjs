/** Tables whose columns are not Boresight's: what they hold is asked, guessed and remembered. */
import assert from 'node:assert/strict';
import { drop, reload, saved, values } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { typeNumber } from '../lib/type.mjs';
import { findings } from '../site/axe.mjs';
import { file, foreign, frames } from './foreign-tables.mjs';

const path = '#/mounting?source=simulated&duration=5&methods=weighted-mean';
const dialog = (page) => page.getByRole('dialog', { name: 'What do the columns hold?' });
const answer = '[aria-busy="false"] [data-row="weighted-mean"] [data-field="angleDeg"][data-value]';
const counts = (page) => page.locator('[data-facts="counts"]').innerText();
const table = (page, group) =>
  dialog(page).getByRole('group', { name: group }).getByRole('combobox', { name: 'Table' });
const select = (page, name) => dialog(page).getByRole('combobox', { name, exact: true });
const chosen = (page, name) => select(page, name).inputValue();
const open = (page) => dialog(page).getByRole('button', { name: 'Open', exact: true });
const columns = (page) => page.getByRole('button', { name: 'Columns', exact: true });
const sessionButton = (page) => page.getByRole('button', { name: 'Save session' });
// It takes no room where nothing lacks.
const lacking = (page, text) =>
  dialog(page).getByRole('status').filter({ hasText: text }).waitFor({ state: 'attached' });

/** Everything in one table, each detection with the car's motion; names tell little. */
function together() {
  const lines = ['t,a,b,c,d'];
  for (const { t, yawRate, speed, seen } of frames())
    for (const { azimuth, rate } of seen)
      lines.push([t, (azimuth * 180) / Math.PI, rate, speed * 3.6, yawRate].map((one) => one.toFixed(5)).join(','));
  return [file('all.csv', lines)];
}

async function given(page, files) {
  await page.waitForSelector(answer);
  await drop(page, files);
}

async function assertAngle(page) {
  await typeNumber(page.getByRole('spinbutton', { name: 'Ahead of rear axle' }), '3.5');
  await page.waitForSelector(answer);
  const [angle] = await values(page, answer);
  assert.ok(Math.abs(angle - 2) < 0.05, `${angle} deg`);
}

browserTest(
  'columns: units and signs of two foreign tables are guessed, and remembered',
  { path },
  async ({ page }) => {
    await given(page, foreign());
    await dialog(page).waitFor();
    assert.equal(await table(page, 'Detections').inputValue(), 'radar log.csv');
    assert.equal(await table(page, 'Motion of the car').inputValue(), 'car.csv.gz');
    const details = {
      'Column of azimuth, detections': 'Azimuth right [rad]',
      'Column of sensor, detections': 'radarName',
      'Column of speed, motion': 'v_ego',
      'Unit of time, detections': 'us',
      'Unit of azimuth, detections': 'rad',
      'Positive values of azimuth, detections': 'flipped',
      'Unit of range rate, detections': 'km/h',
      'Positive values of range rate, detections': 'flipped',
      'Unit of yaw rate, motion': 'rad/s',
      'Positive values of yaw rate, motion': 'same',
    };
    for (const [name, expected] of Object.entries(details)) assert.equal(await chosen(page, name), expected, name);
    assert.match(await page.locator('[data-field="detections-azimuth_deg"]').innerText(), /−55\.00 deg/);
    assert.match(await page.locator('[data-preview="radar log.csv"]').innerText(), /0,959931/);
    await open(page).click();
    await dialog(page).waitFor({ state: 'detached' });
    await page.waitForSelector('[data-notice="place"]');
    assert.match(await page.locator('.files.own').innerText(), /radar log\.csv[\s\S]*car\.csv\.gz/);
    assert.match(await counts(page), /Detections in the files\s*4.802[\s\S]*Without finite numbers\s*2/);
    await assertAngle(page);

    await reload(page);
    await page
      .getByRole('status')
      .filter({ hasText: /files that are not here/ })
      .waitFor();
    await drop(page, foreign());
    await page.waitForSelector(answer);
    assert.equal(await dialog(page).count(), 0, 'it is not asked again');
    await columns(page).click();
    assert.equal(await chosen(page, 'Positive values of azimuth, detections'), 'flipped', 'and can be changed');
  },
);

browserTest('columns: places in metres stand in for azimuth and range', { path }, async ({ page }) => {
  const radar = ['time_s,X [m],Y right [m],doppler'];
  const car = ['time_s,yaw_rate_degps,speed_mps'];
  for (const { t, yawRate, speed, seen } of frames()) {
    car.push(`${t},${(yawRate * 180) / Math.PI},${speed}`);
    for (const { azimuth, rate, range } of seen)
      radar.push(`${t},${range * Math.cos(azimuth)},${-range * Math.sin(azimuth)},${rate}`);
  }
  radar.push('23,,1,0');
  await given(page, [file('targets.csv', radar), file('motion.csv', car)]);
  await dialog(page).waitFor();
  for (const [name, expected] of Object.entries({
    'Column of azimuth, detections': '',
    'Column of x, along boresight, detections': 'X [m]',
    'Column of y, across, detections': 'Y right [m]',
    'Positive values of y, across, detections': 'flipped',
  }))
    assert.equal(await chosen(page, name), expected, name);
  const first = (name) => page.locator(`[data-field="detections-${name}"] td`).last().innerText();
  assert.equal(await first('azimuth_deg'), '−55.00 deg');
  assert.equal(await first('range_m'), '10.00 m');
  assert.equal(await first('y_m'), '−8.192 m');
  await lacking(page, /^$/);
  await select(page, 'Column of y, across, detections').selectOption('');
  await lacking(page, /azimuth of the detections/);
  await select(page, 'Column of y, across, detections').selectOption('Y right [m]');
  await open(page).click();
  await page.waitForSelector('[data-notice="place"]');
  assert.match(await counts(page), /Detections in the files\s*4.801[\s\S]*Without finite numbers\s*1/);
  await assertAngle(page);
});

browserTest('columns: one table holds detections and motion, chosen by keyboard', { path }, async ({ page }) => {
  await given(page, together());
  await dialog(page).waitFor();
  assert.equal(await chosen(page, 'Column of time, detections'), 't');
  await lacking(page, /azimuth of the detections, range rate/);
  assert.ok(await open(page).isDisabled());
  const type = async (control, keys) => {
    for (let tabs = 0; tabs < 60 && !(await control.evaluate((node) => node === document.activeElement)); tabs++)
      await page.keyboard.press('Tab');
    assert.ok(await control.evaluate((node) => node === document.activeElement), `${control}`);
    await page.keyboard.press(keys);
  };
  await type(select(page, 'Column of azimuth, detections'), 'a');
  await type(select(page, 'Column of range rate, detections'), 'b');
  await type(table(page, 'Motion of the car'), 'a');
  await type(select(page, 'Column of yaw rate, motion'), 'd');
  await type(select(page, 'Column of speed, motion'), 'c');
  await type(select(page, 'Unit of speed, motion'), 'k');
  assert.equal(await chosen(page, 'Unit of azimuth, detections'), 'deg');
  assert.equal(await chosen(page, 'Unit of yaw rate, motion'), 'rad/s');
  await type(open(page), 'Enter');
  await page.waitForSelector('[data-notice="place"]');
  assert.match(await counts(page), /Motion samples\s*300/);
  await assertAngle(page);
});

browserTest(
  'columns: cancelled, what was open stays; a wrong unit is said where it is mended',
  { path },
  async ({ page }) => {
    const [radar, car] = foreign();
    await given(page, [radar, car]);
    await dialog(page).waitFor();
    await page.keyboard.press('Escape');
    await dialog(page).waitFor({ state: 'detached' });
    assert.match(await page.locator('[data-fact="name"]').innerText(), /seed/);
    await page
      .getByRole('alert')
      .filter({ hasText: /The drive opened before is still shown/ })
      .waitFor();
    await columns(page).click();
    await dialog(page).waitFor();
    await select(page, 'Column of azimuth, detections').selectOption('Distance (m)');
    await select(page, 'Unit of azimuth, detections').selectOption('rad');
    await open(page).click();
    await dialog(page)
      .getByRole('alert')
      .filter({ hasText: /at most one turn/ })
      .waitFor();
    await select(page, 'Column of azimuth, detections').selectOption('Azimuth right [rad]');
    await open(page).click();
    await page.waitForSelector('[data-notice="place"]');
    assert.equal(await page.getByRole('alert').count(), 0);
  },
);

browserTest('columns: templates open as they are', { path }, async ({ page }) => {
  await page.waitForSelector(answer);
  await page.getByText('About this page').click();
  const templates = [];
  for (const group of ['detections', 'motion'])
    templates.push(await saved(page, page.getByRole('button', { name: `template-${group}.csv` })));
  await drop(page, templates);
  await page.locator('[data-fact="name"]').filter({ hasText: 'csv' }).waitFor();
  assert.match(await counts(page), /Detections in the files\s*2\s*Motion samples\s*2$/);
  assert.equal(await dialog(page).count(), 0);
});

browserTest('columns: a session has the tables as they were read', { path }, async ({ page, browser, url }) => {
  await given(page, foreign());
  await dialog(page).waitFor();
  await open(page).click();
  await page.waitForSelector('[data-notice="place"]');
  const { bytes } = await saved(page, sessionButton(page));
  const context = await browser.newContext();
  const other = await context.newPage();
  await other.goto(`${url}#/networks`);
  await sessionButton(other).and(other.locator(':enabled')).waitFor();
  await drop(other, [{ name: 'drive.boresight', bytes }]);
  await other.waitForSelector('[data-notice="place"]');
  assert.match(await counts(other), /Detections in the files\s*4.802[\s\S]*Without finite numbers\s*2/);
  assert.equal(await dialog(other).count(), 0, 'nobody is asked');
  await context.close();
});

for (const [viewport, scheme] of [
  ['desktop', 'light'],
  ['phone', 'dark'],
])
  browserTest(`columns: axe has no finding, ${viewport}, ${scheme}`, { path, viewport, scheme }, async ({ page }) => {
    await given(page, foreign());
    await dialog(page).waitFor();
    assert.deepEqual(await findings(page), []);
    const { width, right } = await page
      .locator('[data-field="detections-azimuth_deg"]')
      .evaluate((row) => ({ width: innerWidth, right: row.getBoundingClientRect().right }));
    assert.ok(right <= width, `fields end at ${right} of ${width}`);
  });
