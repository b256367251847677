/** Calibration of the array on the page of captures: made, checked, saved, opened, refused, cancelled. */
import assert from 'node:assert/strict';
import { clickWhenThere, drop, parameters, parametersWith, recording, reload, saved, values } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { patient } from '../lib/trial.mjs';
import { leave, typeNumber } from '../lib/type.mjs';
import { findings } from '../site/axe.mjs';

const path = '#/capture';
const PANEL = '[data-panel="array-calibration"]';
/** What the board itself reported at 2.95 m. */
const BOARD_DEG = -10.8;

const ready = (page) =>
  page.waitForSelector('[aria-busy="false"] [data-table="detections"] [data-field="rangeM"][data-value]', patient);
const effect = (page) => page.locator('[data-in-effect]').innerText();
const effected = (page, text) =>
  page.waitForFunction((wanted) => document.querySelector('[data-in-effect]')?.textContent.includes(wanted), text);
const button = (page, action) => page.locator(`${PANEL} [data-action="${action}"]`);
/** Once the cell is seen both ways under the present calibration. */
const compared = (page) =>
  page.waitForSelector('[data-before-after][aria-busy="false"] [data-row="others-after"] [data-value]', patient);
const alertOf = (page) => page.locator('[role="alert"][data-error]').first();

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
  const chosen = rows.nth(index).locator('button');
  await chosen.focus();
  await page.keyboard.press('Enter');
  await parametersWith(page, (params) => params.get('cell'));
}

async function chooseFile(page, name, content) {
  const [chooser] = await Promise.all([page.waitForEvent('filechooser'), button(page, 'open-calibration').click()]);
  await chooser.setFiles({ name, mimeType: 'application/octet-stream', buffer: Buffer.from(content) });
}

browserTest(
  'array calibration: from even frames, the odd ones have one target where the board saw it',
  { path },
  async ({ page }) => {
    await ready(page);
    assert.match(await effect(page), /none: the configuration has none/);
    await chooseTarget(page);
    // By the keyboard alone.
    await button(page, 'self-calibrate').focus();
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
    await page.locator('select[name="calibration"]').selectOption('none');
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
    await button(page, 'add-reflector').click();
    const azimuth = page.locator('[name="reflector-azimuth-0"]');
    await page.waitForFunction(() => document.activeElement?.getAttribute('name') === 'reflector-azimuth-0');
    await typeNumber(azimuth, '-10.8');
    await leave(azimuth);
    // Another cell by a click on the map.
    const plot = page
      .locator('[data-plot="range-doppler"] .plot .u-over, [data-plot="range-doppler"] .plot canvas')
      .first();
    await plot.scrollIntoViewIfNeeded();
    const box = await plot.boundingBox();
    const cell = parameters(page).get('cell');
    await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2);
    await parametersWith(page, (params) => params.get('cell') !== cell);
    await button(page, 'add-reflector').click();
    assert.equal(await page.locator('[data-reflector]').count(), 2);
    await page.getByRole('button', { name: 'Remove reflector 2' }).click();
    assert.equal(await page.locator('[data-reflector]').count(), 1);
    await parametersWith(page, (params) => /^2\.9\d*:-10\.8:0$/.test(params.get('reflectors') ?? ''));
    await button(page, 'calibrate-reflectors').click();
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
    const range = page.locator('[name="reflector-range-0"]');
    await typeNumber(range, '11.5');
    await leave(range);
    await button(page, 'calibrate-reflectors').click();
    await alertOf(page).waitFor();
    assert.match(await alertOf(page).innerText(), /reflector/);
  },
);

browserTest(
  'array calibration: what is saved is opened again, in a session too, and a link says where it is missing',
  { path },
  async ({ page }) => {
    await ready(page);
    await button(page, 'self-calibrate').click();
    await compared(page);
    const rows = () => values(page, '[data-channel] [data-field][data-value]');
    const wanted = await rows();
    const json = await saved(page, `${PANEL} [data-export="json"]`);
    const line = await saved(page, `${PANEL} [data-export="line"]`);
    const session = await saved(page, '[data-action="save-session"]');
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
    await page.locator('[data-action="replace"]').click();
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
    await page.waitForFunction(() => document.querySelector('.files')?.textContent.includes('mine.cfg'));
    await page.locator('select[name="calibration"]').selectOption('configured');
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
    await page
      .waitForFunction(
        (wanted) => document.querySelector('[role="alert"][data-error]')?.textContent.includes(wanted),
        name,
        { timeout: 10_000 },
      )
      .catch(async () => assert.fail(`${name}: ${await page.locator('[role="alert"]').allInnerTexts()}`));
    assert.match(await alertOf(page).innerText(), says);
    assert.match(await effect(page), /none: the configuration has none/, `${name} changes nothing`);
  }
  // No cell is strong enough.
  const least = page.locator('[name="calibrationSnr"]');
  await typeNumber(least, '120');
  await leave(least);
  await button(page, 'self-calibrate').click();
  const alert = page.locator(`${PANEL} [role="alert"]`);
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
  await page.waitForFunction(() => document.querySelector('.files')?.textContent.includes('long.bin'));
  await ready(page);
  const cancelled = clickWhenThere(page, `${PANEL} [data-action="cancel-calibration"]`);
  await button(page, 'self-calibrate').click();
  await cancelled;
  await page.waitForSelector(`${PANEL} [data-cancelled]`);
  assert.match(await effect(page), /none: the configuration has none/);
  await button(page, 'resume-calibration').click();
  await effected(page, 'long.calibration.json');
});

for (const scheme of ['light', 'dark'])
  browserTest(
    `array calibration: no finding of axe once it is made, phone, ${scheme}`,
    { path: `${path}?reflectors=2.95:-10.8:0`, viewport: 'phone', scheme },
    async ({ page }) => {
      await ready(page);
      await button(page, 'self-calibrate').click();
      await compared(page);
      await page.locator('[data-cells] > summary').click();
      assert.deepEqual(await findings(page), []);
      const { scroll, width } = await page.evaluate(() => ({
        scroll: document.documentElement.scrollWidth,
        width: document.documentElement.clientWidth,
      }));
      assert.ok(scroll <= width, `${scroll} px of ${width}`);
    },
  );
