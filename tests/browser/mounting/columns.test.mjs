/** Tables whose columns are not Boresight's: what they hold is asked, guessed and remembered. */
import assert from 'node:assert/strict';
import { drop, reload, saved, values } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { typeNumber } from '../lib/type.mjs';
import { findings } from '../site/axe.mjs';
import { file, foreign, frames } from './foreign-tables.mjs';

const path = '#/mounting?source=simulated&duration=5&methods=weighted-mean';
const dialog = 'dialog.columns[open]';
const answer = '[aria-busy="false"] [data-row="weighted-mean"] [data-field="angleDeg"][data-value]';
const counts = (page) => page.locator('[data-facts="counts"]').innerText();
const select = (page, name) => page.locator(`${dialog} select[name="${name}"]`);
const chosen = async (page, name) => select(page, name).inputValue();

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
  await typeNumber(page.locator('input[name="xM"]'), '3.5');
  await page.waitForSelector(answer);
  const [angle] = await values(page, answer);
  assert.ok(Math.abs(angle - 2) < 0.05, `${angle} deg`);
}

browserTest(
  'columns: units and signs of two foreign tables are guessed, and remembered',
  { path },
  async ({ page }) => {
    await given(page, foreign());
    await page.waitForSelector(dialog);
    const names = [
      'detections-table',
      'motion-table',
      'detections-azimuth_deg',
      'detections-sensor',
      'motion-speed_mps',
    ];
    assert.deepEqual(await Promise.all(names.map((name) => chosen(page, name))), [
      'radar log.csv',
      'car.csv.gz',
      'Azimuth right [rad]',
      'radarName',
      'v_ego',
    ]);
    const details = {
      'detections-time_s-unit': 'us',
      'detections-azimuth_deg-unit': 'rad',
      'detections-azimuth_deg-sign': 'flipped',
      'detections-range_rate_mps-unit': 'km/h',
      'detections-range_rate_mps-sign': 'flipped',
      'motion-yaw_rate_degps-unit': 'rad/s',
      'motion-yaw_rate_degps-sign': 'same',
    };
    for (const [name, expected] of Object.entries(details)) assert.equal(await chosen(page, name), expected, name);
    assert.match(await page.locator('[data-field="detections-azimuth_deg"]').innerText(), /−55\.00 deg/);
    assert.match(await page.locator('[data-preview="radar log.csv"]').innerText(), /0,959931/);
    await page.locator('[data-action="open-columns"]').click();
    await page.waitForSelector(dialog, { state: 'detached' });
    await page.waitForSelector('[data-notice="place"]');
    assert.match(await page.locator('.files.own').innerText(), /radar log\.csv[\s\S]*car\.csv\.gz/);
    assert.match(await counts(page), /Detections in the files\s*4.802[\s\S]*Without finite numbers\s*2/);
    await assertAngle(page);

    await reload(page);
    await page.waitForSelector('[role="status"].notice');
    await drop(page, foreign());
    await page.waitForSelector(answer);
    assert.equal(await page.locator(dialog).count(), 0, 'it is not asked again');
    await page.locator('[data-action="columns"]').click();
    assert.equal(await chosen(page, 'detections-azimuth_deg-sign'), 'flipped', 'and can be changed');
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
  await page.waitForSelector(dialog);
  for (const [name, expected] of Object.entries({
    'detections-azimuth_deg': '',
    'detections-x_m': 'X [m]',
    'detections-y_m': 'Y right [m]',
    'detections-y_m-sign': 'flipped',
  }))
    assert.equal(await chosen(page, name), expected, name);
  const first = (name) => page.locator(`[data-field="detections-${name}"] td`).last().innerText();
  assert.equal(await first('azimuth_deg'), '−55.00 deg');
  assert.equal(await first('range_m'), '10.00 m');
  assert.equal(await first('y_m'), '−8.192 m');
  assert.equal(await page.locator('[data-columns="lacking"]').innerText(), '');
  await select(page, 'detections-y_m').selectOption('');
  assert.match(await page.locator('[data-columns="lacking"]').innerText(), /azimuth of the detections/);
  await select(page, 'detections-y_m').selectOption('Y right [m]');
  await page.locator('[data-action="open-columns"]').click();
  await page.waitForSelector('[data-notice="place"]');
  assert.match(await counts(page), /Detections in the files\s*4.801[\s\S]*Without finite numbers\s*1/);
  await assertAngle(page);
});

browserTest('columns: one table holds detections and motion, chosen by keyboard', { path }, async ({ page }) => {
  await given(page, together());
  await page.waitForSelector(dialog);
  assert.equal(await chosen(page, 'detections-time_s'), 't');
  assert.match(await page.locator('[data-columns="lacking"]').innerText(), /azimuth of the detections, range rate/);
  assert.ok(await page.locator('[data-action="open-columns"]').isDisabled());
  const type = async (name, keys) => {
    for (let tabs = 0; tabs < 60; tabs++) {
      if ((await page.evaluate(() => document.activeElement.name)) === name) break;
      await page.keyboard.press('Tab');
    }
    assert.equal(await page.evaluate(() => document.activeElement.name), name);
    await page.keyboard.press(keys);
  };
  await type('detections-azimuth_deg', 'a');
  await type('detections-range_rate_mps', 'b');
  await type('motion-table', 'a');
  await type('motion-yaw_rate_degps', 'd');
  await type('motion-speed_mps', 'c');
  await type('motion-speed_mps-unit', 'k');
  assert.equal(await chosen(page, 'detections-azimuth_deg-unit'), 'deg');
  assert.equal(await chosen(page, 'motion-yaw_rate_degps-unit'), 'rad/s');
  for (let tabs = 0; tabs < 60; tabs++) {
    if ((await page.evaluate(() => document.activeElement.dataset.action)) === 'open-columns') break;
    await page.keyboard.press('Tab');
  }
  await page.keyboard.press('Enter');
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
    await page.waitForSelector(dialog);
    await page.keyboard.press('Escape');
    await page.waitForSelector(dialog, { state: 'detached' });
    assert.match(await page.locator('[data-fact="name"]').innerText(), /seed/);
    assert.match(
      await page.locator('[role="alert"][data-error]').innerText(),
      /The drive opened before is still shown/,
    );
    await page.locator('[data-action="columns"]').click();
    await page.waitForSelector(dialog);
    await select(page, 'detections-azimuth_deg').selectOption('Distance (m)');
    await select(page, 'detections-azimuth_deg-unit').selectOption('rad');
    await page.locator('[data-action="open-columns"]').click();
    await page.waitForSelector('[data-columns="problem"]');
    assert.match(await page.locator('[data-columns="problem"]').innerText(), /at most one turn/);
    await select(page, 'detections-azimuth_deg').selectOption('Azimuth right [rad]');
    await page.locator('[data-action="open-columns"]').click();
    await page.waitForSelector('[data-notice="place"]');
    assert.equal(await page.locator('[role="alert"][data-error]').count(), 0);
  },
);

browserTest('columns: templates open as they are', { path }, async ({ page }) => {
  await page.waitForSelector(answer);
  await page.locator('summary', { hasText: 'About this page' }).click();
  const templates = [];
  for (const group of ['detections', 'motion']) templates.push(await saved(page, `[data-template="${group}"]`));
  await drop(page, templates);
  await page.waitForFunction(() => document.querySelector('[data-fact="name"]')?.textContent.includes('csv'));
  assert.match(await counts(page), /Detections in the files\s*2\s*Motion samples\s*2$/);
  assert.equal(await page.locator(dialog).count(), 0);
});

browserTest('columns: a session has the tables as they were read', { path }, async ({ page, browser, url }) => {
  await given(page, foreign());
  await page.waitForSelector(dialog);
  await page.locator('[data-action="open-columns"]').click();
  await page.waitForSelector('[data-notice="place"]');
  const { bytes } = await saved(page, '[data-action="save-session"]');
  const context = await browser.newContext();
  const other = await context.newPage();
  await other.goto(`${url}#/networks`);
  await other.waitForSelector('[data-action="save-session"]:enabled');
  await drop(other, [{ name: 'drive.boresight', bytes }]);
  await other.waitForSelector('[data-notice="place"]');
  assert.match(await counts(other), /Detections in the files\s*4.802[\s\S]*Without finite numbers\s*2/);
  assert.equal(await other.locator(dialog).count(), 0, 'nobody is asked');
  await context.close();
});

for (const [viewport, scheme] of [
  ['desktop', 'light'],
  ['phone', 'dark'],
])
  browserTest(`columns: axe has no finding, ${viewport}, ${scheme}`, { path, viewport, scheme }, async ({ page }) => {
    await given(page, foreign());
    await page.waitForSelector(dialog);
    assert.deepEqual(await findings(page), []);
    const { width, right } = await page
      .locator('[data-field="detections-azimuth_deg"]')
      .evaluate((row) => ({ width: innerWidth, right: row.getBoundingClientRect().right }));
    assert.ok(right <= width, `fields end at ${right} of ${width}`);
  });
