/**
 * “Copy as code”: what the dialog gives is run, and has to give the numbers that the page shows. JavaScript gives every
 * bit; the command line is another program, and gives them to `close`.
 */
import assert from 'node:assert/strict';
import { codeOf } from './code-dialog.mjs';
import { runCommands, runScript } from './code-run.mjs';
import { drop, recording } from './demo.mjs';
import { browserTest } from './harness.mjs';
import { patient } from './trial.mjs';

/** Rows of a table by name, each with its numbers (and truths) by field; those of several targets are lists. */
const tableOf = (page, table) =>
  page.locator(`[data-table="${table}"] [data-row]`).evaluateAll((rows) => {
    const all = {};
    for (const row of rows) {
      all[row.dataset.row] ??= {};
      const fields = all[row.dataset.row];
      for (const { dataset } of row.querySelectorAll('[data-field]')) {
        if (dataset.value === undefined) continue;
        fields[dataset.field] ??= [];
        fields[dataset.field].push(Number.isNaN(Number(dataset.value)) ? dataset.value : Number(dataset.value));
      }
    }
    return all;
  });

/** Waits until rows are there and of the present state. */
const settled = (page, table, names, done = '[data-value]') =>
  page.waitForFunction(
    ([table, names, done]) =>
      names.every((name) => {
        const rows = [...document.querySelectorAll(`[data-table="${table}"] [data-row="${name}"]`)];
        return rows.length && rows.every((row) => !row.classList.contains('stale') && row.querySelector(done));
      }),
    [table, names, done],
    patient,
  );

/** Lines of a script by their first word, without it. */
function linesBy(lines) {
  const by = new Map();
  for (const [name, ...values] of lines) by.set(name, [...(by.get(name) ?? []), values]);
  return by;
}

function assertNear(actual, expected, close, what) {
  assert.ok(Math.abs(actual - expected) <= close, `${what}: ${actual} and ${expected}`);
}

/** Sources that the command line lists, beside the lines that a script printed. */
function assertListed(listed, printed, close, what) {
  assert.equal(listed.length, printed.length, what);
  listed.forEach(({ azimuthDeg, powerDb }, k) => {
    assertNear(azimuthDeg, printed[k][0], close, `${what}, azimuth`);
    assertNear(powerDb, printed[k][1], close, `${what}, power`);
  });
}

async function checkAngle(page, methods, close) {
  await settled(page, 'results', methods, 'td:last-child:not(:empty)');
  await page.waitForFunction(
    () => !/–\s*$/.test(document.querySelector('[data-table="results"] tbody').innerText),
    null,
    patient,
  );
  const table = await tableOf(page, 'results');
  assert.deepEqual(Object.keys(table), methods);
  const bounds = await page
    .locator('[data-table="results"] [data-field="crb"]')
    .evaluateAll((cells) => cells.map(({ dataset }) => Number(dataset.value)));
  const code = await codeOf(page);
  const printed = linesBy(await runScript(code.javascript.text));
  assert.deepEqual(printed.get('bound') ?? [], bounds.length ? [bounds] : []);
  const listed = await runCommands(code.commandLine.text);
  assert.equal(listed.length, methods.length);
  methods.forEach((method, i) => {
    const lines = printed.get(method) ?? [];
    const found = lines.map(([azimuth]) => azimuth);
    for (const azimuth of table[method].azimuth ?? [])
      assert.ok(found.includes(azimuth), `${method}: ${azimuth}, ${found}`);
    for (const sigma of table[method]['azimuth-deviation'] ?? [])
      assert.ok(
        lines.some((line) => line[3] === sigma),
        method,
      );
    assertListed(listed[i], lines, close, method);
  });
  return code;
}

browserTest('code: the angle lab as it opens', { path: '#/angle' }, async ({ page }) => {
  const { javascript } = await checkAngle(page, ['bartlett', 'capon', 'music', 'root-music'], 1e-9);
  // What is so by default is not said.
  assert.ok(!/snrDb: 20,\n|gridPoints/.test(javascript.text), javascript.text);
});

browserTest(
  'code: the angle lab with an array of its own, errors of its elements, coherent targets, counting and refinement',
  {
    path: '#/angle?array=at:0,1,2.5,4,5:0.5,7&targets=-8:0,6.5:-3,20:-1&snr=13.5&snapshots=50&seed=4294967295&fluctuation=coherent&gain=1&phase=5&position=0.05&coupling=-20&sources=mdl&grid=2048&refine=1&methods=bartlett,iaa,nomp,maximum-likelihood',
  },
  async ({ page }) => {
    await checkAngle(page, ['bartlett', 'iaa', 'nomp', 'maximum-likelihood'], 1e-6);
  },
);

browserTest(
  'code: the angle lab with averaging and smoothing, and a changed setting changes the code',
  {
    path: '#/angle?array=ula16&targets=-8:0,6:-3&snapshots=50&fluctuation=coherent&average=1&smoothing=10&methods=music,esprit',
  },
  async ({ page }) => {
    const before = await checkAngle(page, ['music', 'esprit'], 1e-9);
    await page.locator('[data-row="music"] [data-field="azimuth"][data-value]').first().waitFor();
    await page.locator('#method-capon').check();
    const after = await checkAngle(page, ['capon', 'music', 'esprit'], 1e-9);
    assert.notEqual(after.javascript.text, before.javascript.text);
    assert.notEqual(after.commandLine.text, before.commandLine.text);
  },
);

browserTest(
  'code: the angle lab with networks, of two targets and of noise alone',
  {
    path: '#/angle?array=lrr48&targets=-5:0,12:-3&snapshots=1&methods=bartlett,aaetr,learned-pursuit',
    timeout: 180_000,
  },
  async ({ page, url }) => {
    await checkAngle(page, ['bartlett', 'aaetr', 'learned-pursuit'], 1e-3);
    await page.goto(`${url}#/angle?array=lrr48&targets=-&snapshots=1&methods=bartlett,learned-pursuit`);
    await page.waitForFunction(() => !document.querySelector('[data-field="crb"]'), null, patient);
    await checkAngle(page, ['bartlett', 'learned-pursuit'], 1e-3);
  },
);

/** Of a capture: detections, and the cell's angles. */
async function checkCapture(page, cells, close, files = {}) {
  await page.waitForSelector(
    '[aria-busy="false"] [data-table="detections"] [data-field="rangeM"][data-value]',
    patient,
  );
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
    await checkCapture(page, ['bartlett', 'iaa'], 1e-3);
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
      .at(-1)
      .map(({ rangeM, coarseAzimuthDeg, sources, targets }) => [
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
    await page.waitForSelector(
      '[aria-busy="false"] [data-table="detections"] [data-field="rangeM"][data-value]',
      patient,
    );
    await drop(
      page,
      [bin.subarray(0, half), bin.subarray(half), cfg].map((bytes, i) => ({ name: names[i], bytes })),
    );
    await page.waitForFunction((name) => document.querySelector('.files')?.textContent.includes(name), names[0]);
    const files = { [names[0]]: bin.subarray(0, half), [names[1]]: bin.subarray(half), [names[2]]: cfg };
    const { code } = await checkCapture(page, ['bartlett', 'capon', 'iaa'], 1e-4, files);
    for (const { needs } of Object.values(code)) for (const name of names) assert.ok(needs.includes(name), needs);
  },
);

const IMAGE = ['outsideDb', 'peakOutsideDb', 'litOutside', 'litTargets', 'cells', 'sources', 'unresolved', 'outside'];

async function checkBirdseye(page, methods, fields = IMAGE) {
  await settled(page, 'results', methods);
  const table = await tableOf(page, 'results');
  const code = await codeOf(page);
  const printed = linesBy(await runScript(code.javascript.text));
  for (const method of methods)
    assert.deepEqual(printed.get(method), [fields.map((name) => table[method][name]?.[0])], method);
  return { code, table };
}

browserTest('code: bird’s eye as it opens', { path: '#/birdseye', timeout: 180_000 }, async ({ page }) => {
  const methods = ['bartlett', 'iaa', 'nomp'];
  const { code, table } = await checkBirdseye(page, methods);
  const told = await runCommands(code.commandLine.text);
  methods.forEach((method, i) => {
    const [row] = told[i];
    assert.equal(row.method, method);
    // It looks further to the sides than the page, as the dialog says.
    for (const field of ['outsideDb', 'peakOutsideDb'])
      assertNear(row[field], table[method][field][0], 0.01, `${method}, ${field}`);
    for (const field of ['litOutside', 'litTargets'])
      assertNear(row[field], table[method][field][0], 1e-4, `${method}, ${field}`);
  });
  assert.ok(code.commandLine.lacks.some((lack) => lack.includes('90°')));
});

browserTest(
  'code: bird’s eye with settings of its own and a network, which the command line cannot do',
  {
    path: '#/birdseye?seed=3&speed=4&radars=left,right&methods=capon,learned-pursuit&falseAlarm=1e-4&grouping=1&gate=2&reach=40&from=targets&refine=1&points=512',
    timeout: 180_000,
  },
  async ({ page }) => {
    const { code } = await checkBirdseye(page, ['capon', 'learned-pursuit']);
    assert.equal(code.commandLine.text, '');
    assert.match(code.commandLine.lacks[0], /no option for the false-alarm rate/);
  },
);

browserTest(
  'code: bird’s eye of the capture',
  { path: '#/birdseye?source=capture&frame=2&methods=bartlett,iaa' },
  async ({ page }) => {
    const { code } = await checkBirdseye(page, ['bartlett', 'iaa'], IMAGE.slice(4));
    assert.equal(code.commandLine.text, '');
  },
);

const CALIBRATION = [
  'angleDeg',
  'sigmaDeg',
  'converged',
  'misaligned',
  'scale',
  'scaleSigma',
  'biasDegps',
  'biasSigmaDegps',
  'inlierShare',
  'used',
];

async function checkMounting(page, ways, close) {
  await settled(page, 'results', ways);
  const table = await tableOf(page, 'results');
  const code = await codeOf(page);
  const printed = linesBy(await runScript(code.javascript.text));
  const told = await runCommands(code.commandLine.text);
  assert.equal(told.length, ways.length);
  ways.forEach((way, i) => {
    const [values] = printed.get(way);
    // A drive need not tell all.
    const fields = CALIBRATION.filter((field) => table[way][field]);
    assert.ok(fields.length >= 8, `${fields}`);
    for (const field of fields)
      assert.equal(values[CALIBRATION.indexOf(field)], table[way][field][0], `${way}, ${field}`);
    for (const field of ['angleDeg', 'sigmaDeg', 'scale', 'biasDegps'])
      if (table[way][field]) assertNear(told[i][field], table[way][field][0], close, `${way}, ${field}`);
    assert.equal(told[i].frames.used, table[way].used[0]);
  });
  return code;
}

browserTest('code: the bundled drive as it opens', { path: '#/mounting', timeout: 180_000 }, async ({ page }) => {
  await checkMounting(page, ['recursive', 'weighted-mean', 'least-squares'], 1e-9);
});

browserTest(
  'code: the bundled drive with a place and limits of its own',
  {
    path: '#/mounting?xM=3&yM=0.1&nominal=-1&minSpeed=1&alarm=0.5&converged=0.2&rangeRateSigma=0.2&azimuthSigma=1&inlierResidual=0.5&minInliers=4&motion=ransac&methods=recursive,orthogonal-distance',
    timeout: 180_000,
  },
  async ({ page }) => {
    await checkMounting(page, ['recursive', 'orthogonal-distance'], 1e-9);
  },
);

// The command line reads the drive from files in single precision.
browserTest(
  'code: a simulated drive, all of its radars together too',
  {
    path: '#/mounting?source=simulated&scenario=country-road&seed=7&duration=40&misalignment=-2&moving=30&sensor=2&methods=recursive,kabsch,joint&maxYawRate=60&inlierRatio=0.4',
    timeout: 180_000,
  },
  async ({ page }) => {
    await checkMounting(page, ['recursive', 'kabsch', 'joint'], 1e-3);
  },
);

browserTest(
  'code: a simulated drive with motions by a network',
  {
    path: '#/mounting?source=simulated&seed=1&duration=20&methods=weighted-mean,recursive&motion=deepego-plus&profile=radarscenes',
    timeout: 180_000,
  },
  async ({ page }) => {
    await checkMounting(page, ['recursive', 'weighted-mean'], 1e-3);
  },
);

/** How many truths have an estimate within a gate, one each, nearest pairs first, and their root mean square error. */
function scored(truth, found, gateDeg) {
  const pairs = truth.flatMap((angle, t) => found.map((other, f) => ({ t, f, off: Math.abs(other - angle) })));
  const taken = [];
  for (const pair of pairs.sort((a, b) => a.off - b.off))
    if (pair.off <= gateDeg && taken.every(({ t, f }) => t !== pair.t && f !== pair.f)) taken.push(pair);
  return { found: taken.length, rmse: Math.sqrt(taken.reduce((sum, { off }) => sum + off ** 2, 0) / taken.length) };
}

async function checkNetwork(page, method, gateDeg, truthOf) {
  await page.waitForSelector('[data-attempt] [data-table="attempt"] [data-row]', patient);
  const table = await tableOf(page, 'attempt');
  const code = await codeOf(page);
  const printed = linesBy(await runScript(code.javascript.text));
  assert.equal(Object.keys(table)[0], method);
  for (const [name, { found, rmse, false: extra }] of Object.entries(table)) {
    const angles = (printed.get(name) ?? []).map(([azimuth]) => azimuth);
    const score = scored(truthOf(printed, code), angles, gateDeg);
    assert.equal(score.found, found[0], name);
    assert.equal(angles.length - score.found, extra[0], name);
    if (score.found) assertNear(score.rmse, rmse[0], 1e-12, name);
  }
  return { code, printed, names: Object.keys(table) };
}

for (const [model, query, gateDeg, close] of [
  ['learned-pursuit', 'targets=6&snr=25', 0.5, 1e-3],
  ['aaetr-any', 'targets=4&snr=20&array=ula16&refine=1&seed=5', 0.5, 1e-3],
  ['covariance-cnn', 'targets=2&snr=10', 2, 1e-3],
]) {
  browserTest(
    `code: a scene of the network ${model}`,
    { path: `#/networks?run=1&model=${model}&${query}`, timeout: 180_000 },
    async ({ page }) => {
      const method = model === 'aaetr-any' ? 'aaetr' : model;
      const truth = (printed) => printed.get('truth').map(([azimuth]) => azimuth);
      const { code, printed, names } = await checkNetwork(page, method, gateDeg, truth);
      const listed = await runCommands(code.commandLine.text);
      names.forEach((name, i) => {
        assertListed(listed[i], printed.get(name) ?? [], close, name);
      });
    },
  );
}

browserTest(
  'code: a region of the networks for regions, and a number of targets',
  { path: '#/networks?run=1&model=cnn3d-2&targets=2&snr=10&refine=1', timeout: 180_000 },
  async ({ page, url }) => {
    const truth = (_, { javascript }) =>
      [...javascript.text.matchAll(/azimuthDeg: (-?\d+), rangeM/g)].map(([, angle]) => Number(angle));
    const { code } = await checkNetwork(page, 'cnn3d', 1, truth);
    assert.equal(code.commandLine.text, '');
    assert.match(code.commandLine.lacks[0], /region/);
    await page.goto(`${url}#/networks?run=1&model=counting&targets=2&snr=0&range=together`);
    await page.waitForSelector('[data-attempt] [data-row="mdl-reversed"] [data-value]', patient);
    const table = await tableOf(page, 'attempt');
    const printed = linesBy(await runScript((await codeOf(page)).javascript.text));
    for (const [rule, { sources }] of Object.entries(table)) assert.equal(printed.get(rule)[0][0], sources[0], rule);
  },
);
