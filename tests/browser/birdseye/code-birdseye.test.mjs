/** “Copy as code” of bird’s-eye images. */
import assert from 'node:assert/strict';
import { assertNear, codeOf, linesBy, settled, tableOf } from '../lib/code-dialog.mjs';
import { runCommands, runScript } from '../lib/code-run.mjs';
import { browserTest } from '../lib/harness.mjs';

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

browserTest(
  'code: bird’s eye of two radars',
  { path: '#/birdseye?radars=left,right&methods=bartlett,capon,nomp', timeout: 180_000 },
  async ({ page }) => {
    const { code, table } = await checkBirdseye(page, ['bartlett', 'capon', 'nomp']);
    const told = await runCommands(code.commandLine.text);
    // NOMP has no spectrum.
    assert.ok(
      code.commandLine.lacks.some((lack) => /directions found.*: NOMP\.$/.test(lack)),
      code.commandLine.lacks.join(),
    );
    assert.equal(told.length, 2);
    ['bartlett', 'capon'].forEach((method, i) => {
      const [row] = told[i];
      assert.equal(row.method, method);
      // It looks further to the sides than the page, as the dialog says.
      for (const field of ['outsideDb', 'peakOutsideDb'])
        assertNear(row[field], table[method][field][0], 0.01, `${method}, ${field}`);
      for (const field of ['litOutside', 'litTargets'])
        assertNear(row[field], table[method][field][0], 0.003, `${method}, ${field}`);
    });
    assert.ok(code.commandLine.lacks.some((lack) => lack.includes('90°')));
  },
);

browserTest(
  'code: bird’s eye with settings of its own and a network, which the command line cannot do',
  {
    path: '#/birdseye?seed=3&speed=4&radars=right&methods=iaa,learned-pursuit&falseAlarm=1e-4&grouping=1&gate=2&reach=40&from=targets&refine=1&points=512',
    timeout: 180_000,
  },
  async ({ page }) => {
    const { code } = await checkBirdseye(page, ['iaa', 'learned-pursuit']);
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
