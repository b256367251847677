/** “Copy as code”: what the dialog gives is run, and has to give the numbers that the page shows. */
import assert from 'node:assert/strict';
import { runCommands, runScript } from './code-run.mjs';
import { browserTest } from './harness.mjs';

/** What the dialog shows: text, needs and what is lacking, by tab. */
async function codeOf(page) {
  await page.locator('[data-action="show-code"]').click();
  const dialog = page.locator('[data-dialog="code"]');
  await dialog.waitFor();
  const shown = {};
  for (const [name, title] of [
    ['javascript', 'JavaScript'],
    ['commandLine', 'Command line'],
  ]) {
    await dialog.getByRole('tab', { name: title }).click();
    const panel = dialog.locator(`[data-code="${name}"]`);
    await panel.waitFor();
    const [text = ''] = await panel.locator('pre').allTextContents();
    const [needs = ''] = await panel.locator('[data-needs]').allTextContents();
    shown[name] = { text, needs, lacks: await panel.locator('.lacks li').allTextContents() };
  }
  await page.keyboard.press('Escape');
  await dialog.waitFor({ state: 'detached' });
  return shown;
}

/** The numbers of a table, by row and field. */
const tableOf = (page, table) =>
  page
    .locator(`[data-table="${table}"] [data-row]`)
    .evaluateAll((rows) =>
      Object.fromEntries(
        rows.map((row) => [
          row.dataset.row,
          [...row.querySelectorAll('[data-field]')].flatMap(({ dataset }) =>
            dataset.value === undefined ? [] : [{ ...dataset, value: Number(dataset.value) }],
          ),
        ]),
      ),
    );

/** Lines of a script by their first word, without it. */
function linesBy(lines) {
  const by = new Map();
  for (const [name, ...values] of lines) by.set(name, [...(by.get(name) ?? []), values]);
  return by;
}

const settled = (page, methods) =>
  page.waitForFunction(
    (names) =>
      names.every((name) => {
        const row = document.querySelector(`[data-table="results"] [data-row="${name}"]`);
        return row && !row.classList.contains('stale') && /\d.ms|\d.s/.test(row.lastElementChild.textContent);
      }),
    methods,
    { timeout: 60_000 },
  );

/** Of one scene: each azimuth and bound that the table shows is among those printed, bit for bit. */
async function checkAngle(page, methods, { close = 0 } = {}) {
  await settled(page, methods);
  const table = await tableOf(page, 'results');
  assert.deepEqual(Object.keys(table), methods);
  const bounds = await page
    .locator('[data-table="results"] [data-field="crb"]')
    .evaluateAll((cells) => cells.map(({ dataset }) => Number(dataset.value)));
  const code = await codeOf(page);
  const printed = linesBy(await runScript(code.javascript.text));
  if (bounds.length) assert.deepEqual(printed.get('bound'), [bounds]);
  const listed = await runCommands(code.commandLine.text);
  assert.equal(listed.length, methods.length);
  for (const [i, method] of methods.entries()) {
    const azimuths = table[method].filter(({ field }) => field === 'azimuth').map(({ value }) => value);
    const found = (printed.get(method) ?? []).map(([azimuth]) => azimuth);
    for (const azimuth of azimuths) assert.ok(found.includes(azimuth), `${method}: ${azimuth} among ${found}`);
    assert.equal(listed[i].length, found.length, method);
    listed[i].forEach(({ azimuthDeg, powerDb }, k) => {
      const [azimuth, power] = printed.get(method)[k];
      assert.ok(Math.abs(azimuthDeg - azimuth) <= close, `${method}: ${azimuthDeg} and ${azimuth}`);
      assert.ok(Math.abs(powerDb - power) <= close, `${method}: ${powerDb} and ${power} dB`);
    });
  }
  return code;
}

const ANGLE = '[data-table="results"] [data-row] [data-field="azimuth"][data-value]';

browserTest('code: angle lab as it opens', { path: '#/angle' }, async ({ page }) => {
  await page.waitForSelector(ANGLE);
  const { javascript, commandLine } = await checkAngle(page, ['bartlett', 'capon', 'music', 'root-music'], {
    close: 1e-9,
  });
  console.log(javascript, commandLine);
});

browserTest(
  'code: angle lab with many settings',
  {
    path: '#/angle?array=at:0,1,2.5,4,5:0.5,7&targets=-8:0,6.5:-3,20:-1&snr=13.5&snapshots=50&seed=4294967295&fluctuation=coherent&gain=1&phase=5&position=0.05&coupling=-20&sources=mdl&grid=2048&refine=1&methods=bartlett,iaa,nomp,maximum-likelihood',
  },
  async ({ page }) => {
    await page.waitForSelector(ANGLE);
    const { javascript, commandLine } = await checkAngle(page, ['bartlett', 'iaa', 'nomp', 'maximum-likelihood'], {
      close: 1e-6,
    });
    console.log(javascript, commandLine);
  },
);

browserTest(
  'code: angle lab, noise alone and a network',
  { path: '#/angle?array=lrr48&targets=-&snapshots=1&methods=bartlett,learned-pursuit,aaetr&sources=known' },
  async ({ page }) => {
    const { javascript, commandLine } = await checkAngle(page, ['bartlett', 'aaetr', 'learned-pursuit'], {
      close: 1e-4,
    });
    console.log(javascript, commandLine);
  },
);

const near = (a, b, close) => Math.abs(a - b) <= close;

/** Of a capture: detections, the cell's angles, the board's objects and regions. */
async function checkCapture(page, { cells, close = 0 }) {
  await page.waitForSelector('[data-table="detections"] [data-field="rangeM"][data-value]', { timeout: 60_000 });
  await page.waitForFunction(
    (names) =>
      names.every((name) => {
        const row = document.querySelector(`[data-table="cell"] [data-row="${name}"]`);
        return row && !row.classList.contains('stale') && row.querySelector('[data-value]');
      }),
    cells,
    { timeout: 60_000 },
  );
  const table = await page
    .locator('[data-table="detections"] tr[data-detection]:not([data-detection="board"])')
    .evaluateAll((rows) =>
      rows.map((row) =>
        Object.fromEntries(
          [...row.querySelectorAll('[data-field][data-value]')].map(({ dataset }) => [
            dataset.field,
            Number(dataset.value),
          ]),
        ),
      ),
    );
  const cell = await tableOf(page, 'cell');
  const code = await codeOf(page);
  console.log(code.javascript, code.commandLine);
  const printed = linesBy(await runScript(code.javascript.text));
  const detections = printed.get('detection') ?? [];
  assert.equal(detections.length, table.length);
  assert.ok(table.length > 0);
  const [listed] = await runCommands(code.commandLine.text);
  assert.equal(listed.length, table.length);
  for (const { rangeM, rateMps, azimuthDeg, powerDb, snrDb } of table) {
    const same = detections.find(([range, rate, azimuth]) => range === rangeM && rate === rateMps && azimuth === azimuthDeg);
    assert.ok(same, `a detection at ${rangeM} m, ${azimuthDeg} degrees`);
    assert.deepEqual(same.slice(-2), [powerDb, snrDb]);
    const told = listed.find(
      (row) => near(row.rangeM, rangeM, close) && near(row.rateMps, rateMps, close) && near(row.azimuthDeg, azimuthDeg, close),
    );
    assert.ok(told, `the command line has a detection at ${rangeM} m, ${azimuthDeg} degrees`);
    assert.ok(near(told.powerDb, powerDb, close) && near(told.snrDb, snrDb, close));
  }
  for (const method of cells) {
    const [{ value }] = cell[method].filter(({ field }) => field === 'azimuth');
    assert.equal(printed.get(method)[0][0], value, method);
  }
  return { code, printed };
}

browserTest('code: capture as it opens', { path: '#/capture' }, async ({ page }) => {
  await checkCapture(page, { cells: ['bartlett', 'capon', 'iaa'], close: 1e-6 });
});

browserTest(
  'code: one frame of the capture with many settings',
  {
    path: '#/capture?frame=3&window=blackman&rangePadding=2&dopplerPadding=4&cfar=ordered-statistic&rank=0.6&falseAlarm=1e-4&guardRange=3&grouping=0&nearest=1&sector=60&angle=iaa&methods=bartlett,nomp&sources=2&refine=1&cell=60:30',
  },
  async ({ page }) => {
    await checkCapture(page, { cells: ['bartlett', 'nomp'], close: 1e-4 });
  },
);

browserTest('code: regions of the capture', { path: '#/capture?regions=1&frame=0&methods=bartlett' }, async ({ page }) => {
  await page.waitForSelector('[data-region]', { timeout: 60_000 });
  const shown = await page.locator('[data-region]').evaluateAll((rows) =>
    rows.map((row) => {
      const of = (field) => row.querySelector(`[data-field="${field}"]`).dataset.value;
      return [Number(of('rangeM')), Number(of('coarse')), Number(of('sources')), ...of('azimuths').split(',').filter(Boolean).map(Number)];
    }),
  );
  const { code, printed } = await checkCapture(page, { cells: ['bartlett'], close: 1e-6 });
  assert.deepEqual(printed.get('region'), shown);
  const told = (await runCommands(code.commandLine.text)).at(-1);
  console.log(JSON.stringify(told).slice(0, 600));
});

const BIRDSEYE = ['outsideDb', 'peakOutsideDb', 'litOutside', 'litTargets', 'cells', 'sources', 'unresolved', 'outside'];

async function checkBirdseye(page, methods, fields = BIRDSEYE) {
  await page.waitForFunction(
    (names) =>
      names.every((name) => {
        const row = document.querySelector(`[data-table="results"] [data-row="${name}"]`);
        return row && !row.classList.contains('stale') && row.querySelector('[data-value]');
      }),
    methods,
    { timeout: 80_000 },
  );
  const table = await tableOf(page, 'results');
  const code = await codeOf(page);
  console.log(code.javascript, code.commandLine);
  const printed = linesBy(await runScript(code.javascript.text));
  for (const method of methods) {
    const shown = fields.map((name) => table[method].find(({ field }) => field === name).value);
    assert.deepEqual(printed.get(method), [shown], method);
  }
  const told = code.commandLine.text ? await runCommands(code.commandLine.text) : [];
  for (const [i, [row]] of told.entries()) {
    console.log(row, printed.get(methods[i]));
  }
  return code;
}

browserTest('code: bird’s eye as it opens', { path: '#/birdseye' }, async ({ page }) => {
  await checkBirdseye(page, ['bartlett', 'iaa', 'nomp']);
});

browserTest(
  'code: bird’s eye with many settings',
  { path: '#/birdseye?seed=3&speed=4&radars=left,right&methods=capon,learned-pursuit&falseAlarm=1e-4&grouping=1&gate=2&reach=40&from=targets&refine=1' },
  async ({ page }) => {
    await checkBirdseye(page, ['capon', 'learned-pursuit']);
  },
);

browserTest('code: bird’s eye of the capture', { path: '#/birdseye?source=capture&frame=2&methods=bartlett,iaa' }, async ({ page }) => {
  await checkBirdseye(page, ['bartlett', 'iaa'], BIRDSEYE.slice(4));
});

const MOUNTING = ['angleDeg', 'sigmaDeg', 'converged', 'misaligned', 'scale', 'scaleSigma', 'biasDegps', 'biasSigmaDegps', 'inlierShare', 'used'];

async function checkMounting(page, ways, { close = 0 } = {}) {
  await page.waitForFunction(
    (names) =>
      names.every((name) => {
        const row = document.querySelector(`[data-table="results"] [data-row="${name}"]`);
        return row && !row.classList.contains('stale') && row.querySelector('[data-value]');
      }),
    ways,
    { timeout: 80_000 },
  );
  const rows = await page
    .locator('[data-table="results"] [data-row]')
    .evaluateAll((all) => all.map((row) => [row.dataset.row, [...row.querySelectorAll('[data-field][data-value]')].map(({ dataset }) => [dataset.field, dataset.value])]));
  const table = {};
  for (const [name, cells] of rows) table[name] = { ...table[name], ...Object.fromEntries(cells) };
  const code = await codeOf(page);
  console.log(code.javascript, code.commandLine);
  const printed = linesBy(await runScript(code.javascript.text));
  for (const way of ways) {
    const [values] = printed.get(way);
    for (const [i, field] of MOUNTING.entries())
      if (table[way][field] !== undefined) assert.equal(String(values[i]), table[way][field], `${way}: ${field}`);
  }
  const told = code.commandLine.text ? await runCommands(code.commandLine.text) : [];
  for (const [i, row] of told.entries()) {
    for (const field of ['angleDeg', 'sigmaDeg', 'scale']) {
      const difference = Math.abs(row[field] - Number(table[ways[i]][field]));
      assert.ok(!(difference > close), `${ways[i]}: ${field} differs by ${difference}`);
    }
  }
  return code;
}

browserTest('code: mounting as it opens', { path: '#/mounting' }, async ({ page }) => {
  await checkMounting(page, ['recursive', 'weighted-mean', 'least-squares'], { close: 1e-9 });
});

browserTest(
  'code: mounting of a simulated drive',
  { path: '#/mounting?source=simulated&scenario=country-road&seed=7&duration=40&misalignment=-2&sensor=2&methods=recursive,kabsch,joint&alarm=0.5&maxYawRate=60&inlierRatio=0.4' },
  async ({ page }) => {
    await checkMounting(page, ['recursive', 'kabsch', 'joint'], { close: 1e-3 });
  },
);

browserTest(
  'code: mounting with a network',
  { path: '#/mounting?source=simulated&seed=1&duration=20&methods=weighted-mean,recursive&motion=deepego-plus&profile=radarscenes' },
  async ({ page }) => {
    await checkMounting(page, ['recursive', 'weighted-mean'], { close: 1e-3 });
  },
);
