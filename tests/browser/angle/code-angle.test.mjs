/** “Copy as code” of the angle lab. */
import assert from 'node:assert/strict';
import { assertListed, codeOf, linesBy, settled, tableOf } from '../lib/code-dialog.mjs';
import { runCommands, runScript } from '../lib/code-run.mjs';
import { browserTest } from '../lib/harness.mjs';
import { patient } from '../lib/trial.mjs';

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
    await page.getByRole('checkbox', { name: 'Capon (MVDR)' }).check();
    const after = await checkAngle(page, ['capon', 'music', 'esprit'], 1e-9);
    assert.notEqual(after.javascript.text, before.javascript.text);
    assert.notEqual(after.commandLine.text, before.commandLine.text);
  },
);

browserTest(
  'code: the angle lab with a network, and of noise alone',
  {
    path: '#/angle?array=lrr48&targets=-5:0,12:-3&snapshots=1&methods=bartlett,learned-pursuit',
    timeout: 180_000,
  },
  async ({ page, url }) => {
    await checkAngle(page, ['bartlett', 'learned-pursuit'], 1e-3);
    await page.goto(`${url}#/angle?array=lrr48&targets=-&snapshots=1&methods=bartlett,iaa`);
    await page.waitForFunction(() => !document.querySelector('[data-field="crb"]'), null, patient);
    await checkAngle(page, ['bartlett', 'iaa'], 1e-6);
  },
);
