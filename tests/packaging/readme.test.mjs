/** The JavaScript of the README and of docs runs as pasted into an empty project, and the tables of methods are `methods()`. */
import assert from 'node:assert/strict';
import { copyFileSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { root } from '../../scripts/lib/paths.mjs';
import { consumer } from './consumer.mjs';

const page = (path) => readFileSync(join(root, path), 'utf8');
const snippetsOf = (text) => [...text.matchAll(/^```js\n(.*?)^```$/gms)].map(([, code]) => code);
const readme = snippetsOf(page('README.md'));
const javascript = snippetsOf(page('docs/javascript.md'));
const embedding = snippetsOf(page('docs/embedding.md'));
const mounting = snippetsOf(page('docs/mounting-angle.md'));
/** Lines of the pages that may hold a table of methods. */
const lines = ['README.md', 'docs/estimators.md'].flatMap((path) => page(path).split('\n'));
const recording = (name) => join(root, 'recordings', 'awr1642', name);

let project;
before(async () => {
  const files = Object.fromEntries([
    ...readme.map((code, k) => [`readme-${k}.mjs`, code]),
    ...javascript.map((code, k) => [`javascript-${k}.mjs`, code]),
    ...embedding.map((code, k) => [`embedding-${k}.mjs`, code]),
    ...mounting.map((code, k) => [`mounting-${k}.mjs`, code]),
  ]);
  files['methods.mjs'] = `
    import { calibrationMethods, init, methods } from 'boresight';
    await init();
    console.log(JSON.stringify(methods()));
    console.log(JSON.stringify(calibrationMethods()));
  `;
  project = await consumer({ files });
  copyFileSync(recording('xwr16xx_crw_dca_module_2018_1015v2.bin'), join(project.folder, 'capture.bin'));
  copyFileSync(recording('profile.cfg'), join(project.folder, 'profile.cfg'));
  for (const name of ['front_radar.csv.gz', 'pose_10hz.csv.gz']) {
    copyFileSync(join(root, 'recordings', 'delphi', name), join(project.folder, name));
  }
});
after(() => project?.remove());

const printed = async (script) => (await project.run(process.execPath, [script])).stdout.trim().split('\n');

test('every snippet has a test here', () => {
  assert.equal(readme.length, 3);
  assert.equal(javascript.length, 5);
  assert.equal(embedding.length, 1);
  assert.equal(mounting.length, 1);
});

test('a host without workers, as Node is to the single file, has its pool', async () => {
  const [line] = await printed('embedding-0.mjs');
  assert.match(line, /^0 workers, [1-9]\d scans$/);
});

test('limits are set', async () => {
  assert.deepEqual(await printed('javascript-4.mjs'), ['']);
});

test('a network of motion calibrates a simulated drive', async () => {
  const [line] = await printed('mounting-0.mjs');
  const [, angle, sigma] = /^(-?[\d.]+) \+- ([\d.]+) deg$/.exec(line) ?? assert.fail(line);
  // Radar 1 of the RadarScenes car looks to -85 deg.
  assert.ok(Math.abs(Number(angle) + 85) < 1 && Number(sigma) < 0.5, line);
});

test('the first snippet of the README finds both targets with the methods that resolve them', async () => {
  assert.ok(readme[0].trim().split('\n').length <= 15, 'fifteen lines');
  const lines = await printed('readme-0.mjs');
  assert.deepEqual(
    lines.map((line) => line.split(' ')[0]),
    ['bartlett', 'iaa', 'nomp'],
  );
  // 25 dB on 48 elements: the bound on the weaker target is below 0.02 deg, a grid cell is 0.11 deg.
  const nomp = [...lines[2].matchAll(/(-?[\d.]+) deg/g)].map(([, deg]) => Number(deg));
  assert.equal(nomp.length, 2);
  assert.ok(Math.abs(nomp[0] + 5) < 0.1 && Math.abs(nomp[1] + 3) < 0.1, lines[2]);
});

test('the second snippet of the README finds the targets of the capture', async () => {
  const lines = await printed('readme-1.mjs');
  assert.ok(
    lines.some((line) => /^2\.9\d m -1[01]\.\d deg/.test(line)),
    lines.join('\n'),
  );
  assert.ok(
    lines.some((line) => /^4\.9\d m/.test(line)),
    lines.join('\n'),
  );
});

test('the pool reports progress and the shape', async () => {
  const lines = await printed('javascript-0.mjs');
  assert.ok(
    lines.some((line) => line.endsWith('of 500')),
    lines.join('\n'),
  );
  assert.match(lines.at(-1), /500, 48, 1/);
});

test('the third snippet of the README finds the angle of a real radar', async () => {
  const [last, early] = await printed('readme-2.mjs');
  const [, angle, sigma] = /^(-\d\.\d\d) \+- (0\.\d\d) deg from \d{4} of 12003 frames$/.exec(last) ?? assert.fail(last);
  // Stated: -1.96 deg.
  assert.ok(Math.abs(Number(angle) + 1.96) < 0.15 && Number(sigma) < 0.15, last);
  assert.match(early, /^after 60 s -\d\.\d\d \+- \d\.\d\d deg$/);
});

test('the dashboard finds a misaligned radar', async () => {
  const [line] = await printed('javascript-1.mjs');
  const [, angle] = /^(\d+\.\d\d) \+- 0\.\d\d deg, misaligned$/.exec(line) ?? assert.fail(line);
  assert.ok(Math.abs(Number(angle) - 30.5) < 0.1, line);
});

test('the network finds the targets', async () => {
  const lines = await printed('javascript-2.mjs');
  assert.equal(lines.length, 3);
  for (const line of lines) {
    const [, angle, truth] = /^(-?[\d.]+) deg, (-?[\d.]+) in truth$/.exec(line) ?? assert.fail(line);
    // Refined: a tenth of a beamwidth of 1.2 deg is some ten deviations at 25 dB and 48 elements.
    assert.ok(Math.abs(angle - truth) < 0.12, line);
  }
});

test('the networks find the targets in the regions of a cube', async () => {
  const lines = await printed('javascript-3.mjs');
  assert.equal(lines.length, 2);
  assert.match(lines[0], /^70 m: 1, at -4 deg$/);
  assert.match(lines[1], /^16\d m: 2, at (-6,5|5,-6) deg$/);
});

test('the table of methods of mounting angles says what calibrationMethods() says', async () => {
  const [, json] = await printed('methods.mjs');
  const expected = JSON.parse(json).map(({ name, title, reference }) => `| \`${name}\` | ${title} | ${reference} |`);
  // Without the heading.
  const [, ...rows] = lines.filter((line) => /^\| `[a-z-]+` \| [^`|]+ \| [^`|]+ \|$/.test(line));
  assert.deepEqual(rows, expected);
});

test('the table of estimators says what methods() says', async () => {
  const [json] = await printed('methods.mjs');
  // Without the heading.
  const [, ...rows] = lines.filter((line) => /^\| .* \| `[a-z0-9-]+` \|/.test(line));
  const yes = (flag) => (flag ? 'yes' : 'no');
  const expected = JSON.parse(json).map((m) => {
    const needs = [
      m.minSnapshots > 1 && m.maxSnapshots === null && `${m.minSnapshots} or more snapshots`,
      m.maxSnapshots === m.minSnapshots && `exactly ${m.maxSnapshots} snapshot${m.maxSnapshots === 1 ? '' : 's'}`,
      m.uniformArray && 'uniform array',
      m.lattice && 'elements on a grid',
      m.sourceCount && 'number of sources, given or counted',
      m.network && 'a model',
    ].filter(Boolean);
    const cells = [
      m.title,
      `\`${m.name}\``,
      m.reference,
      needs.join('; ') || 'nothing more',
      yes(m.takesCovariance),
      yes(m.elevation),
      yes(m.spectrum),
      m.cost,
    ];
    return `| ${cells.join(' | ')} |`;
  });
  assert.deepEqual(rows, expected);
});
