/** The examples in the comments of the package's sources, which the API reference shows, print what they say. */
import assert from 'node:assert/strict';
import { copyFileSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { root } from '../../scripts/lib/paths.mjs';
import { recordingBytes } from '../../scripts/lib/recordings.mjs';
import { consumer } from './consumer.mjs';

const sources = ['web/lib', 'web/worker'].flatMap((folder) =>
  readdirSync(join(root, folder), { recursive: true })
    .filter((name) => name.endsWith('.ts'))
    .map((name) => `${folder}/${name}`),
);

/** Each example with the source and the name it is of. */
const examples = sources.flatMap((path) => {
  const text = readFileSync(join(root, path), 'utf8');
  return [...text.matchAll(/ \* @example\n \* ```js\n(.*?) \* ```\n \*\/\nexport \w+ (\w+)/gs)].map(
    ([, lines, name]) => ({ path, name, code: lines.replaceAll(/^ \* ?/gm, '') }),
  );
});
const promised = (code) => [...code.matchAll(/\/\/ → (.*)$/gm)].map(([, line]) => line);

let project;
before(async () => {
  project = await consumer({ files: Object.fromEntries(examples.map(({ name, code }) => [`${name}.mjs`, code])) });
  const recorded = 'recordings/awr1642/xwr16xx_crw_demo_visualizer_2018_1015v2.dat';
  copyFileSync(join(root, recorded), join(project.folder, 'board.dat'));
  copyFileSync(join(root, 'tests/golden/hdf5/matlab.mat'), join(project.folder, 'measured.mat'));
  writeFileSync(join(project.folder, 'drive.mcap'), await recordingBytes({ seconds: 5 }));
});
after(() => project?.remove());

test('examples stand at what a newcomer looks for', () => {
  const count = sources.reduce(
    (sum, path) => sum + readFileSync(join(root, path), 'utf8').split('@example').length - 1,
    0,
  );
  assert.equal(examples.length, count, 'all are of the form that is read here');
  const names = new Set(examples.map(({ name }) => name));
  assert.equal(names.size, examples.length);
  for (const name of ['estimate', 'simulateCube', 'calibrateDrive', 'Calibration', 'createPool', 'Network']) {
    assert.ok(names.has(name), name);
  }
});

for (const { path, name, code } of examples) {
  test(`${name} (${path})`, async () => {
    const { stdout } = await project.run(process.execPath, [`${name}.mjs`]);
    assert.ok(promised(code).length > 0, 'an example says what it prints');
    assert.deepEqual(stdout.trimEnd().split('\n'), promised(code));
  });
}
