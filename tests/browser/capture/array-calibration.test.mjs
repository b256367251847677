/** Calibration of the array on the page of captures: made, checked, saved, opened, refused, cancelled. */
import assert from 'node:assert/strict';
import { button, cancelOf, choose, combobox, plotOf, region, spinbutton } from '../lib/controls.mjs';
import { clickWhenThere, drop, parameters, parametersWith, recording, reload, saved, values } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { patient } from '../lib/trial.mjs';
import { leave, typeNumber } from '../lib/type.mjs';
import { findings } from '../site/axe.mjs';
import { opened, ready } from './page.mjs';

const path = '#/capture';
const panel = (page) => region(page, 'Array calibration');
/** What the board itself reported at 2.95 m. */
const BOARD_DEG = -10.8;

const effect = (page) => page.locator('[data-in-effect]').innerText();
const effected = (page, text) => page.locator('[data-in-effect]', { hasText: text }).waitFor();
const press = (page, name) => button(panel(page), name).click();
const calibration = (page) => combobox(page, 'Array calibration');
const reflectors = (page) => page.locator('[data-reflector]');
/** Once the cell is seen both ways under the present calibration. */
const compared = (page) =>
  page.waitForSelector('[data-before-after][aria-busy="false"] [data-row="others-after"] [data-value]', patient);
const alertOf = (page) => page.getByRole('alert').first();

/** A row of the cell before and after. */
async function row(page, name) {
  const of = (field) => page.locator(`[data-row="${name}"] [data-field="${field}"]`).getAttribute('data-value');
  const [sidelobe, nomp, mdl, azimuths] = await Promise.all(['sidelobe', 'nomp', 'mdl', 'azimuths'].map(of));
  return {
    ...{ sidelobe: Number(sidelobe), nomp: Number(nomp), mdl: Number(mdl) },
    azimuths: azimuths.split(',').map(Number),
  };
}

/** Chooses the cell of the target at 2.95 m by its row in the table of detections. */
async function chooseTarget(page) {
  const rows = page.locator('[data-table="detections"] tbody tr.pick');
  const ranges = await rows.evaluateAll((all) =>
    all.map((one) => Number(one.querySelector('[data-field="rangeM"]').dataset.value)),
  );
  const index = ranges.findIndex((range) => Math.abs(range - 2.95) < 0.05);
  assert.ok(index >= 0, `a target at 2.95 m among ${ranges}`);
  const chosen = rows.nth(index).getByRole('button');
  await chosen.focus();
  await page.keyboard.press('Enter');
  await parametersWith(page, (params) => params.get('cell'));
}

const chooseFile = (page, name, bytes) => choose(page, button(panel(page), 'Open calibration'), [{ name, bytes }]);

browserTest(
  'array calibration: from even frames, the odd ones have one target where the board saw it',
  { path },
  async ({ page }) => {
    await ready(page);
    assert.match(await effect(page), /none: the configuration has none/);
    await chooseTarget(page);
    // By the keyboard alone.
    await button(panel(page), 'Self-calibrate').focus();
    await page.keyboard.press('Enter');
    await compared(page);
    assert.match(await effect(page), /xwr16xx_crw_dca_module_2018_1015v2\.calibration\.json/);
    const [before, after] = [await row(page, 'others-before'), await row(page, 'others-after')];
    assert.ok(before.nomp > 1, `the plan splits the target: ${before.azimuths}`);
    assert.equal(after.nomp, 1, `one target by NOMP: ${after.azimuths}`);
    assert.ok(Math.abs(after.azimuths[0] - BOARD_DEG) <= 1, `at ${after.azimuths[0]} degrees`);
    assert.ok(before.mdl > 1 && after.mdl === 1, `targets by MDL: ${before.mdl} to ${after.mdl}`);
    assert.ok(after.sidelobe < before.sidelobe - 1, `sidelobe ${before.sidelobe} to ${after.sidelobe} dB`);
    // Uncertainty of every channel, and what is not told.
    const channels = await page.locator('[data-channel]').count();
    assert.equal(channels, 8);
    for (const field of ['gainDb', 'phaseDeg']) {
      const deviations = await page
        .locator(`[data-field="${field}"]`)
        .evaluateAll((cells) => cells.map(({ dataset }) => Number(dataset.deviation)));
      assert.ok(deviations.length === 8 && deviations.every((one) => one > 0 && one < 20), `${field}: ${deviations}`);
    }
    assert.match(
      await page.locator('[data-not-identifiable]').getAttribute('data-not-identifiable'),
      /common-gain,common-phase,direction/,
    );
    const [phaseBefore, phaseAfter] = await values(page, '[data-row="residualPhaseDeg"] [data-value]');
    assert.ok(phaseAfter < phaseBefore, `phase left on frames not used: ${phaseBefore} to ${phaseAfter} degrees`);
    // The detections are calibrated, too, and without it they are as before.
    await calibration(page).selectOption('none');
    await effected(page, 'none, by choice');
    await parametersWith(page, (params) => params.get('calibration') === 'none');
    assert.equal(await page.locator('[data-before-after]').count(), 0);
  },
);

browserTest(
  'array calibration: by a reflector that is clicked and its angle, in the list and out of it',
  { path },
  async ({ page }) => {
    await ready(page);
    await chooseTarget(page);
    await press(page, 'Add the chosen cell as a reflector');
    const azimuth = page.getByRole('spinbutton', { name: 'Azimuth of reflector 1' });
    await azimuth.and(page.locator(':focus')).waitFor();
    await typeNumber(azimuth, '-10.8');
    await leave(azimuth);
    // Another cell by a click on the map.
    const plot = plotOf(page, 'Range-Doppler map').locator('.u-over');
    await plot.scrollIntoViewIfNeeded();
    const box = await plot.boundingBox();
    const cell = parameters(page).get('cell');
    await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
    await parametersWith(page, (params) => params.get('cell') !== cell);
    await press(page, 'Add the chosen cell as a reflector');
    await reflectors(page).nth(1).waitFor();
    assert.equal(await reflectors(page).count(), 2);
    await press(page, 'Remove reflector 2');
    await reflectors(page).nth(1).waitFor({ state: 'detached' });
    assert.equal(await reflectors(page).count(), 1);
    await parametersWith(page, (params) => /^2\.9\d*:-10\.8:0$/.test(params.get('reflectors') ?? ''));
    await press(page, 'Calibrate by reflectors');
    await chooseTarget(page);
    await compared(page);
    assert.match(await page.locator('[data-facts="array-calibration"]').innerText(), /known angles/);
    assert.doesNotMatch(
      await page.locator('[data-not-identifiable]').getAttribute('data-not-identifiable'),
      /direction/,
    );
    const after = await row(page, 'others-after');
    assert.equal(after.nomp, 1);
    // The direction is the one that was typed.
    assert.ok(Math.abs(after.azimuths[0] - BOARD_DEG) < 0.5, `at ${after.azimuths[0]} degrees`);
    // A reflector where nothing is.
    const range = page.getByRole('spinbutton', { name: 'Range of reflector 1' });
    await typeNumber(range, '11.5');
    await leave(range);
    await press(page, 'Calibrate by reflectors');
    await alertOf(page).waitFor();
    assert.match(await alertOf(page).innerText(), /reflector/);
  },
);

browserTest(
  'array calibration: what is saved is opened again, in a session too, and a link says where it is missing',
  { path },
  async ({ page }) => {
    await ready(page);
    await press(page, 'Self-calibrate');
    await compared(page);
    const rows = () => values(page, '[data-channel] [data-field][data-value]');
    const wanted = await rows();
    const json = await saved(page, button(panel(page), 'JSON'));
    const line = await saved(page, button(panel(page), 'TI line'));
    const session = await saved(page, button(page, 'Save session'));
    assert.match(json.name, /^boresight-array-.*\.calibration\.json$/);
    assert.match(line.bytes.toString(), /^compRangeBiasAndRxChanPhase 0( -?[\d.]+){16}\s*$/);
    await parametersWith(page, (params) => /^own:[0-9a-f]{8}$/.test(params.get('calibration')));
    const id = parameters(page).get('calibration');
    await reload(page);
    await page.waitForSelector('[data-notice="calibration"]');
    await ready(page);
    assert.match(await effect(page), /none: the configuration has none/);
    await drop(page, [{ name: 'mine.calibration.json', bytes: json.bytes }]);
    await effected(page, 'mine.calibration.json');
    assert.equal(await page.locator('[data-notice="calibration"]').count(), 0, 'it is the one of the link');
    await parametersWith(page, (params) => params.get('calibration') === id);
    assert.deepEqual(await rows(), wanted);
    // TI's line has five digits, and no common gain.
    await chooseFile(page, 'line.cfg', line.bytes);
    await effected(page, 'line.calibration.json');
    const rounded = await rows();
    const mean = (of) => of.reduce((sum, one) => sum + one, 0) / of.length;
    const gains = (of) => of.filter((_, i) => i % 2 === 0);
    const shift = mean(gains(wanted));
    wanted.forEach((value, i) => {
      const expected = i % 2 === 0 ? value - shift : value;
      assert.ok(Math.abs(rounded[i] - expected) < 0.01, `${rounded[i]} for ${expected}`);
    });
    await drop(page, [{ name: session.name, bytes: session.bytes }]);
    await button(page.getByRole('dialog'), 'Open the session').click();
    await effected(page, 'xwr16xx');
    await parametersWith(page, (params) => params.get('calibration') === id);
    assert.deepEqual(await rows(), wanted);
  },
);

browserTest(
  'array calibration: a table of measured steering vectors, and the line of a configuration, give the errors they hold',
  { path },
  async ({ page }) => {
    await ready(page);
    const [gainsDb, phasesDeg] = [
      [0.5, -0.5, 1, -1, 0.2, -0.2, 0.7, -0.7],
      [0, 20, -15, 40, -60, 5, 90, -35],
    ];
    const factor = (k) => [10 ** (gainsDb[k] / 20), (phasesDeg[k] * Math.PI) / 180];
    // The elements lie at y = 0, -1 ... -7 half wavelengths.
    const response = (deg) =>
      gainsDb.map((_, k) => {
        const [gain, phase] = factor(k);
        const angle = phase - Math.PI * k * Math.sin((deg * Math.PI) / 180);
        return [gain * Math.cos(angle), gain * Math.sin(angle)];
      });
    const azimuthDeg = [-40, 0, 25];
    const table = { azimuthDeg, responses: azimuthDeg.map(response) };
    await drop(page, [{ name: 'table.json', bytes: Buffer.from(JSON.stringify(table)) }]);
    await effected(page, 'table.calibration.json');
    const told = async () => {
      const all = await values(page, '[data-channel] [data-field][data-value]');
      return [
        all.filter((_, i) => i % 2 === 0),
        all.filter((_, i) => i % 2 === 1).map((one, _, [first]) => one - first),
      ];
    };
    const close = ([gains, phases], within) => {
      gains.forEach((one, k) => assert.ok(Math.abs(one - gainsDb[k]) < within, `gain ${k}: ${one} dB`));
      phases.forEach((one, k) => {
        const apart = ((((one - phasesDeg[k]) % 360) + 540) % 360) - 180;
        assert.ok(Math.abs(apart) < within, `phase ${k}: ${one} degrees`);
      });
    };
    close(await told(), 0.02);
    // Coefficients are what the channels are multiplied by.
    const line = gainsDb.map((_, k) => {
      const [gain, phase] = factor(k);
      return `${(Math.cos(phase) / gain).toFixed(5)} ${(-Math.sin(phase) / gain).toFixed(5)}`;
    });
    const cfg = recording('profile.cfg')
      .toString()
      .replace(/^compRangeBiasAndRxChanPhase.*$/gm, '');
    await drop(page, [
      { name: 'mine.bin', bytes: recording('xwr16xx_crw_dca_module_2018_1015v2.bin') },
      { name: 'mine.cfg', bytes: Buffer.from(`${cfg}\ncompRangeBiasAndRxChanPhase 0.05 ${line.join(' ')}\n`) },
    ]);
    await opened(page, 'mine.cfg');
    await calibration(page).selectOption('configured');
    await effected(page, 'of the configuration');
    await page.waitForFunction(() =>
      /Range bias\s*0\.050 m/.test(document.querySelector('[data-facts="array-calibration"]')?.innerText),
    );
    close(await told(), 0.02);
  },
);

browserTest('array calibration: what cannot be used is refused, and says what helps', { path }, async ({ page }) => {
  await ready(page);
  const neutral = (tx, rx) => ({ tx, rx, channels: tx.flatMap(() => rx.map(() => ({ gainDb: 0, phaseDeg: 0 }))) });
  const y = (list) => list.map((one) => [0, one, 0]);
  for (const [name, content, says] of [
    ['cut.calibration.json', '{"tx": [[0, 0', /cut\.calibration\.json: it is no JSON, or is cut off.*Save JSON/],
    ['other.calibration.json', '{"a": 1}', /it is other JSON; a calibration with tx, rx and channels/],
    [
      'cascade.calibration.json',
      JSON.stringify(neutral(y([0, -4, -8]), y([0, -1, -2, -3]))),
      /cascade.*It is of another array: choose the one it was made for under Detection, Virtual array/,
    ],
    [
      'short.calibration.json',
      JSON.stringify({ ...neutral(y([0, -4]), y([0, -1, -2, -3])), channels: [] }),
      /channels/,
    ],
    ['few.cfg', 'compRangeBiasAndRxChanPhase 0.0 1 0 1 0\n', /few\.cfg.*compRangeBiasAndRxChanPhase/],
    ['none.txt', 'sensorStart\n', /it has no line compRangeBiasAndRxChanPhase/],
  ]) {
    await chooseFile(page, name, content);
    await alertOf(page)
      .filter({ hasText: name })
      .waitFor({ timeout: 10_000 })
      .catch(async () => assert.fail(`${name}: ${await page.getByRole('alert').allInnerTexts()}`));
    assert.match(await alertOf(page).innerText(), says);
    assert.match(await effect(page), /none: the configuration has none/, `${name} changes nothing`);
  }
  // No cell is strong enough.
  const least = spinbutton(page, 'Least SNR');
  await typeNumber(least, '120');
  await leave(least);
  await press(page, 'Self-calibrate');
  const alert = panel(page).getByRole('alert');
  await alert.waitFor(patient);
  assert.match(await alert.innerText(), /Lower “Least SNR”/);
});

browserTest('array calibration: ends when it is cancelled, and goes on when asked', { path }, async ({ page }) => {
  await ready(page);
  const bin = recording('xwr16xx_crw_dca_module_2018_1015v2.bin');
  await drop(page, [
    { name: 'long.bin', bytes: bin, times: 24 },
    { name: 'long.cfg', bytes: recording('profile.cfg') },
  ]);
  await opened(page, 'long.bin');
  await ready(page);
  const cancelled = clickWhenThere(page, cancelOf('Calibrating the array'));
  await press(page, 'Self-calibrate');
  await cancelled;
  await panel(page).locator('[data-cancelled]').waitFor();
  assert.match(await effect(page), /none: the configuration has none/);
  await press(page, 'Calibrate again');
  await effected(page, 'long.calibration.json');
});

for (const scheme of ['light', 'dark'])
  browserTest(
    `array calibration: no finding of axe once it is made, phone, ${scheme}`,
    { path: `${path}?reflectors=2.95:-10.8:0`, viewport: 'phone', scheme },
    async ({ page }) => {
      await ready(page);
      await press(page, 'Self-calibrate');
      await compared(page);
      await panel(page).getByText('Cells it was made from, and those left out').click();
      assert.deepEqual(await findings(page), []);
      const { scroll, width } = await page.evaluate(() => ({
        scroll: document.documentElement.scrollWidth,
        width: document.documentElement.clientWidth,
      }));
      assert.ok(scroll <= width, `${scroll} px of ${width}`);
    },
  );
