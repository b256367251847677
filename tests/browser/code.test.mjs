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
  page.locator(`[data-table="${table}"] [data-row]`).evaluateAll((rows) =>
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
  const { javascript, commandLine } = await checkAngle(page, ['bartlett', 'capon', 'music', 'root-music'], { close: 1e-9 });
  console.log(javascript, commandLine);
});

browserTest(
  'code: angle lab with many settings',
  {
    path: '#/angle?array=at:0,1,2.5,4,5:0.5,7&targets=-8:0,6.5:-3,20:-1&snr=13.5&snapshots=50&seed=4294967295&fluctuation=coherent&gain=1&phase=5&position=0.05&coupling=-20&sources=mdl&grid=2048&refine=1&methods=bartlett,iaa,nomp,maximum-likelihood',
  },
  async ({ page }) => {
    await page.waitForSelector(ANGLE);
    const { javascript, commandLine } = await checkAngle(page, ['bartlett', 'iaa', 'nomp', 'maximum-likelihood'], { close: 1e-6 });
  console.log(javascript, commandLine);
  },
);

browserTest(
  'code: angle lab, noise alone and a network',
  { path: '#/angle?array=lrr48&targets=-&snapshots=1&methods=bartlett,learned-pursuit,aaetr&sources=known' },
  async ({ page }) => {
    const { javascript, commandLine } = await checkAngle(page, ['bartlett', 'aaetr', 'learned-pursuit'], { close: 1e-4 });
  console.log(javascript, commandLine);
  },
);
