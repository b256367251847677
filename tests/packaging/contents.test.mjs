import assert from 'node:assert/strict';
import { readFileSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { publint } from 'publint';
import { root } from '../../scripts/lib/paths.mjs';
import { pack, temporaryFolder } from './consumer.mjs';

const manifest = JSON.parse(readFileSync(join(root, 'package.json'), 'utf8'));
const folder = temporaryFolder();
let files;
let size;
before(async () => ({ files, size } = await pack(folder)));
after(() => rmSync(folder, { recursive: true, force: true }));

const targets = (value) => (typeof value === 'string' ? [value] : Object.values(value).flatMap(targets));

test('every file that the export map names is in the package', () => {
  for (const target of targets(manifest.exports).filter((target) => !target.includes('*'))) {
    assert.ok(files.includes(target.replace('./', '')), `${target} is missing`);
  }
});

test('licence, notice, readme and change log are in the package', () => {
  for (const name of ['LICENSE', 'LICENSE-APACHE', 'NOTICE', 'README.md', 'CHANGELOG.md']) {
    assert.ok(files.includes(name), `${name} is missing`);
  }
});

test('each script has its types, and nothing else is in the package', () => {
  const scripts = files.filter((name) => /^dist\/(lib|worker|inline)\/.*(?<!\.worker)\.js$/.test(name));
  assert.ok(scripts.length > 0);
  for (const name of scripts) assert.ok(files.includes(name.replace(/\.js$/, '.d.ts')), `${name} has no types`);
  const belongs =
    /^(dist\/.*\.(js|d\.ts|wasm)|dist\/elements\/(custom-elements\.json|LICENSES\.md)|web\/lib\/generated\/schema\.json|models\/(motion\/)?[a-z0-9-]+\.(onnx|json|bin)|package\.json|LICENSE(-APACHE)?|NOTICE|README\.md|CHANGELOG\.md)$/;
  assert.deepEqual(
    files.filter((name) => !belongs.test(name)),
    [],
  );
});

test('the package is small: one core wasm and little besides', () => {
  assert.equal(files.filter((name) => name === 'dist/wasm/boresight_bg.wasm').length, 1);
  // The module of networks takes some 4.1 MB, and again in its single file; the networks 3.7 MB, of which the two of AAETR 2.2;
  // each of the two other single files 1.5 MB. None is loaded unless asked for.
  assert.ok(size < 17_200_000, `${size} bytes packed`);
});

test('the licences of what is bundled are in the package', () => {
  const licences = readFileSync(join(root, 'dist', 'elements', 'LICENSES.md'), 'utf8');
  for (const name of ['uplot', 'd3-scale-chromatic', 'd3-interpolate', 'd3-color'])
    assert.match(licences, new RegExp(`## ${name}`));
});

test('installing the package runs nothing and brings nothing', () => {
  for (const name of ['preinstall', 'install', 'postinstall']) assert.equal(manifest.scripts[name], undefined);
  assert.equal(manifest.dependencies, undefined);
});

test('publint has nothing to say', async () => {
  const { messages } = await publint({ pkgDir: root, strict: true });
  assert.deepEqual(messages, []);
});
