/** “Copy as code” of captures. */
import assert from 'node:assert/strict';
import { assertNear, codeOf, linesBy, settled, tableOf } from '../lib/code-dialog.mjs';
import { runCommands, runScript } from '../lib/code-run.mjs';
import { button } from '../lib/controls.mjs';
import { drop, recording } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { patient } from '../lib/trial.mjs';
import { opened, ready } from './page.mjs';
import { json, setup, studio } from './studio.mjs';

/** Of a capture: detections, and the cell's angles. */
async function checkCapture(page, cells, close, files = {}) {
  await ready(page);
  await settled(page, 'cell', cells);
  const rows = await page
    .locator('[data-table="detections"] tr[data-detection]:not([data-detection="board"])')
    .evaluateAll((all) =>
      all.map((row) =>
        Object.fromEntries(
          [...row.querySelectorAll('[data-field][data-value]')].map(({ dataset }) => [
            dataset.field,
            Number(dataset.value),
          ]),
        ),
      ),
    );
  const board = await page
    .locator('[data-field="boardRangeM"][data-value]')
    .evaluateAll((all) => all.map(({ dataset }) => Number(dataset.value)));
  const cell = await tableOf(page, 'cell');
  const code = await codeOf(page);
  const printed = linesBy(await runScript(code.javascript.text, files));
  // The first line names the columns.
  const [columns, ...detections] = printed.get('detection');
  const shown = detections.map((line) => Object.fromEntries(columns.map((name, i) => [name, line[i]])));
  const told = await runCommands(code.commandLine.text, files);
  assert.ok(rows.length > 0);
  for (const list of [shown, told[0]]) assert.equal(list.length, rows.length);
  for (const row of rows) {
    const { rangeM, rateMps, azimuthDeg, powerDb, snrDb } = row;
    const mine = { rangeM, rateMps, azimuthDeg, powerDb, snrDb };
    const same = (other) => Object.entries(mine).every(([key, value]) => Object.is(other[key], value));
    assert.ok(shown.some(same), `a detection as ${JSON.stringify(mine)}`);
    const near = (other) => Object.entries(mine).every(([key, value]) => Math.abs(other[key] - value) <= close);
    assert.ok(told[0].some(near), `the command line has a detection near ${JSON.stringify(mine)}`);
  }
  for (const range of board)
    assert.ok(
      printed.get('board').some(([own]) => own === range),
      `the board’s at ${range} m`,
    );
  for (const method of cells) assert.equal(printed.get(method)[0][0], cell[method].azimuth[0], method);
  return { code, printed, told, board };
}

// Transforms are in single precision, and the command line has another plan for them: levels differ by some 1e-6 dB.
browserTest('code: the capture as it opens', { path: '#/capture' }, async ({ page }) => {
  const { board } = await checkCapture(page, ['bartlett', 'capon', 'iaa'], 1e-4);
  assert.ok(board.length > 0);
});

browserTest(
  'code: one frame of the capture, with windows, padding, CFAR, limits and method of its own',
  {
    path: '#/capture?frame=3&window=blackman&dopplerWindow=hamming&rangePadding=2&dopplerPadding=4&cfar=ordered-statistic&rank=0.6&falseAlarm=1e-4&guardRange=3&grouping=0&nearest=1&sector=60&angle=iaa&methods=bartlett,iaa&sources=2&refine=1&cell=117:32&board=17',
  },
  async ({ page }) => {
    // IAA makes more of the differences: 0.010 degrees and 0.006 dB here.
    await checkCapture(page, ['bartlett', 'iaa'], 0.03);
  },
);

browserTest(
  'code: regions of a frame of the capture by networks',
  { path: '#/capture?regions=1&frame=1&methods=bartlett', timeout: 180_000 },
  async ({ page }) => {
    await page.waitForSelector('[data-region]', patient);
    const shown = await page.locator('[data-region]').evaluateAll((rows) =>
      rows.map((row) => {
        const of = (field) => row.querySelector(`[data-field="${field}"]`).dataset.value;
        const azimuths = of('azimuths').split(',').filter(Boolean);
        return [of('rangeM'), of('coarse'), of('sources'), ...azimuths].map(Number);
      }),
    );
    const { printed, told } = await checkCapture(page, ['bartlett'], 1e-4);
    assert.deepEqual(printed.get('region'), shown);
    const listed = told
      .at(-1)[0]
      .regions.map(({ rangeM, coarseAzimuthDeg, sources, targets }) => [
        ...[rangeM, coarseAzimuthDeg, sources],
        ...targets.map(({ azimuthDeg }) => azimuthDeg),
      ]);
    assert.equal(listed.length, shown.length);
    listed.forEach((line, i) => {
      assert.equal(line.length, shown[i].length);
      line.forEach((value, k) => assertNear(value, shown[i][k], 1e-3, `region ${i}, ${k}`));
    });
  },
);

browserTest(
  'code: a capture of one’s own, whose names a shell would trip over',
  { path: '#/capture' },
  async ({ page }) => {
    const bin = recording('xwr16xx_crw_dca_module_2018_1015v2.bin');
    const cfg = recording('profile.cfg');
    const half = Math.floor(bin.length / 2);
    const names = ["-it's $HOME `x`_Raw_0.bin", "-it's $HOME `x`_Raw_1.bin", '--config "a\nb".cfg'];
    await ready(page);
    await drop(
      page,
      [bin.subarray(0, half), bin.subarray(half), cfg].map((bytes, i) => ({ name: names[i], bytes })),
    );
    await opened(page, names[0]);
    const files = { [names[0]]: bin.subarray(0, half), [names[1]]: bin.subarray(half), [names[2]]: cfg };
    const { code } = await checkCapture(page, ['bartlett', 'capon', 'iaa'], 1e-4, files);
    for (const { needs } of Object.values(code)) for (const name of names) assert.ok(needs.includes(name), needs);
  },
);

browserTest('code: a capture with the files of mmWave Studio', { path: '#/capture' }, async ({ page }) => {
  const bin = recording('xwr16xx_crw_dca_module_2018_1015v2.bin');
  await ready(page);
  await drop(page, [json('b.mmwave.json', studio()), json('b.setup.json', setup), { name: 'b.bin', bytes: bin }]);
  await opened(page, 'b.bin');
  const texts = { 'b.mmwave.json': JSON.stringify(studio()), 'b.setup.json': JSON.stringify(setup) };
  await checkCapture(page, ['bartlett', 'capon', 'iaa'], 1e-4, { 'b.bin': bin, ...texts });
});

browserTest(
  'code: a capture under an array calibration that was made here',
  { path: '#/capture?methods=bartlett,nomp' },
  async ({ page }) => {
    await button(page, 'Self-calibrate').click(patient);
    await page.waitForSelector('[aria-busy="false"] [data-before-after] [data-row="others-after"]', patient);
    const { code } = await checkCapture(page, ['bartlett', 'nomp'], 1e-4);
    assert.match(code.javascript.text, /const calibration = \{/);
    assert.match(code.commandLine.text, /cat > array\.calibration\.json <<'EOF'/);
  },
);
