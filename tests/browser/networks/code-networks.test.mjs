/** “Copy as code” of scenes of networks. */
import assert from 'node:assert/strict';
import { assertListed, assertNear, codeOf, linesBy, tableOf } from '../lib/code-dialog.mjs';
import { runCommands, runScript } from '../lib/code-run.mjs';
import { browserTest } from '../lib/harness.mjs';
import { patient } from '../lib/trial.mjs';

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
  ['learned-pursuit', 'targets=6&snr=25&refine=1&seed=5', 0.5, 1e-3],
  ['covariance-cnn', 'targets=2&snr=10', 2, 1e-3],
]) {
  browserTest(
    `code: a scene of the network ${model}`,
    { path: `#/networks?run=1&model=${model}&${query}`, timeout: 180_000 },
    async ({ page }) => {
      const truth = (printed) => printed.get('truth').map(([azimuth]) => azimuth);
      const { code, printed, names } = await checkNetwork(page, model, gateDeg, truth);
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
