/** “Copy as code” of mounting angles. */
import assert from 'node:assert/strict';
import { unzipSync } from 'fflate';
import { assertNear, codeOf, linesBy, settled, tableOf } from '../lib/code-dialog.mjs';
import { runCommands, runScript } from '../lib/code-run.mjs';
import { drop, saved } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { typeNumber } from '../lib/type.mjs';
import { foreign } from './foreign-tables.mjs';

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

async function checkMounting(page, ways, close, files = {}) {
  await settled(page, 'results', ways);
  const table = await tableOf(page, 'results');
  const code = await codeOf(page);
  const printed = linesBy(await runScript(code.javascript.text, files));
  const told = await runCommands(code.commandLine.text, files);
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
    const { javascript } = await checkMounting(page, ['orthogonal-distance'], 1e-9);
    // The recursive method takes no motions by RANSAC, as the page says.
    assert.match(javascript.lacks[0], /^Recursive robust likelihood is left out, as it did not run: /);
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
    await checkMounting(page, ['recursive', 'kabsch', 'joint'], 1e-5);
  },
);

browserTest(
  'code: a simulated drive with motions by a network',
  {
    path: '#/mounting?source=simulated&seed=1&duration=20&methods=weighted-mean,recursive&motion=deepego-plus&profile=radarscenes',
    timeout: 180_000,
  },
  async ({ page }) => {
    await checkMounting(page, ['recursive', 'weighted-mean'], 1e-5);
  },
);

browserTest(
  'code: tables with columns of their own, as the saved session has them',
  { path: '#/mounting?source=simulated&duration=5&methods=weighted-mean', timeout: 180_000 },
  async ({ page }) => {
    await settled(page, 'results', ['weighted-mean']);
    await drop(page, foreign());
    await page.getByRole('dialog').getByRole('button', { name: 'Open' }).click();
    await page.waitForSelector('[data-notice="place"]');
    const nothing = await codeOf(page);
    assert.equal(nothing.javascript.text, '');
    assert.match(nothing.javascript.lacks[0], /place is not known/);
    await typeNumber(page.getByRole('spinbutton', { name: 'Ahead of rear axle' }), '3.5');
    await settled(page, 'results', ['weighted-mean']);
    const { bytes } = await saved(page, page.getByRole('button', { name: 'Save session' }));
    const files = Object.fromEntries(
      Object.entries(unzipSync(bytes)).flatMap(([name, content]) =>
        name.startsWith('mounting/') ? [[name.slice('mounting/'.length), content]] : [],
      ),
    );
    assert.equal(Object.keys(files).length, 2);
    const { javascript } = await checkMounting(page, ['weighted-mean'], 1e-9, files);
    assert.match(javascript.needs, /save the session, a ZIP archive/);
    for (const name of Object.keys(files)) assert.ok(javascript.text.includes(name), name);
  },
);
