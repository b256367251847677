import assert from 'node:assert/strict';
import { randomBytes } from 'node:crypto';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { problems, workspaceGraph } from '../../scripts/lib/checks/dependency-rules.mjs';
import { licenceAllowed, npmLicences } from '../../scripts/lib/checks/licences.mjs';
import { coreLimits, inlineLimits, overLimit, sizes } from '../../scripts/lib/checks/sizes.mjs';
import { atLeast, lockedVersion } from '../../scripts/lib/checks/versions.mjs';
import { countVectorOpcodes, vectorInstructions } from '../../scripts/lib/checks/wasm-simd.mjs';

const graph = (crates) =>
  workspaceGraph({
    packages: Object.entries(crates).map(([name, dependencies]) => ({
      name: `boresight-${name}`,
      dependencies: dependencies.map(([dependency, kind = null]) => ({
        name: dependency,
        kind,
        ...(dependency.startsWith('boresight-') && { path: '/somewhere' }),
      })),
    })),
  });

test('dependencies that point the right way pass', () => {
  const good = graph({
    core: [['ndarray']],
    signal: [['boresight-core'], ['boresight-simulate', 'dev']],
    pipeline: [['boresight-core'], ['boresight-signal'], ['boresight-aoa']],
    wasm: [['boresight-pipeline'], ['wasm-bindgen']],
    neural: [['tract-onnx'], ['boresight-core']],
  });
  assert.deepEqual(problems(good), []);
});

test('each dependency rule fails when broken', () => {
  const breaches = {
    'core depends on signal': { core: [['boresight-signal']] },
    'formats depends on signal': { formats: [['boresight-signal']] },
    'mounting depends on aoa': { mounting: [['boresight-aoa']] },
    'core names wasm-bindgen': { core: [['wasm-bindgen']] },
    'signal names js-sys': { signal: [['js-sys', 'dev']] },
    'aoa names tract-onnx': { aoa: [['tract-onnx']] },
    'cli depends on the binding crate wasm': { cli: [['boresight-wasm']] },
    'wasm depends on the binding crate wasm-neural': { wasm: [['boresight-wasm-neural']] },
    'cli depends on experiments': { cli: [['boresight-experiments']] },
    'extra: no layer': { extra: [] },
  };
  for (const [expected, crates] of Object.entries(breaches)) {
    const found = problems(graph(crates));
    assert.equal(found.length, 1, expected);
    assert.ok(found[0].startsWith(expected), `${found[0]} should start with ${expected}`);
  }
});

test('a licence is one on the list, or a choice with one', () => {
  const permitted = ['MIT', 'Apache-2.0', 'ISC'];
  for (const good of ['MIT', 'MIT OR Apache-2.0', 'GPL-3.0-only OR MIT']) {
    assert.equal(licenceAllowed(good, permitted), true, good);
  }
  const bad = [
    undefined,
    '',
    'GPL-3.0-only',
    'MIT AND GPL-3.0-only',
    'GPL-3.0-only OR MIT AND LGPL-2.1',
    '(MIT OR ISC) AND LGPL-2.1',
    'MIT MIT',
    'MIT+',
  ];
  for (const expression of bad) assert.equal(licenceAllowed(expression, permitted), false, expression);
});

test('licences are found for every npm package but our own', () => {
  const packages = { '': { license: 'X' }, 'node_modules/a/node_modules/@b/c': { version: '2.0.0', license: 'ISC' } };
  assert.deepEqual(npmLicences({ packages }), [{ name: '@b/c 2.0.0 (npm)', licence: 'ISC' }]);
});

test('the size limit is on Brotli and is exact', async () => {
  const { brotli } = coreLimits;
  assert.equal(overLimit({ brotli }), null);
  assert.match(overLimit({ brotli: brotli + 1 }), /limit is 535\.0 KB/);
  const noise = await sizes(randomBytes(600_000));
  assert.equal(noise.raw, 600_000);
  assert.ok(noise.brotli > 590_000 && overLimit(noise), 'noise does not compress');
  assert.equal(overLimit(await sizes(Buffer.alloc(500_000))), null);
});

test('the limits of a self-contained file are on both forms', () => {
  const { raw, brotli } = inlineLimits;
  assert.equal(overLimit({ raw, brotli }, inlineLimits), null);
  assert.match(overLimit({ raw: raw + 1, brotli }, inlineLimits), /^2100\.0 KB raw, the limit is 2100\.0 KB$/);
  assert.match(overLimit({ raw: raw + 1, brotli: brotli + 1 }, inlineLimits), / raw.*; .* brotli/);
  assert.equal(overLimit({ raw, brotli }, {}), null);
});

const assemble = async (text) => {
  const { default: binaryen } = await import('binaryen');
  const module = binaryen.parseText(text);
  module.setFeatures(binaryen.Features.All);
  const binary = module.emitBinary();
  module.dispose();
  return binary;
};

test('SIMD instructions are counted in function bodies', async () => {
  const binary = await assemble(`(module (func (export "f") (param v128 v128) (result v128)
    (f32x4.add (f32x4.mul (local.get 0) (local.get 1)) (local.get 1))))`);
  const counts = await vectorInstructions(binary);
  assert.equal(counts.get('f32x4.add'), 1);
  assert.equal(counts.get('f32x4.mul'), 1);
});

test('a module that only speaks of SIMD has none', async () => {
  const binary = await assemble(`(module (memory 1) (data (i32.const 0) "(f32x4.add (v128.load")
    (func (export "f32x4.add") (param f32 f32) (result f32) (f32.add (local.get 0) (local.get 1))))`);
  assert.equal((await vectorInstructions(binary)).size, 0);
  assert.equal(countVectorOpcodes(';; (i8x16.swizzle\n(func)').size, 0);
});

test('Cargo.lock gives the version of one package only', () => {
  const lock = readFileSync(new URL('../../Cargo.lock', import.meta.url), 'utf8');
  assert.match(lockedVersion(lock, 'ndarray'), /^\d+\.\d+\.\d+$/);
  assert.throws(() => lockedVersion(lock, 'no-such-crate'), /0 versions of no-such-crate/);
  const entry = (version) => `[[package]]\nname = "twice"\nversion = "${version}"\n\n`;
  assert.equal(lockedVersion(entry('1.2.3'), 'twice'), '1.2.3');
  assert.throws(() => lockedVersion(entry('1.0.0') + entry('2.0.0'), 'twice'), /2 versions of twice/);
});

test('versions compare by number', () => {
  assert.ok(atLeast('20.19.0', '20.19.0'));
  assert.ok(atLeast('1.100.0', '1.95'));
  assert.ok(!atLeast('20.9.0', '20.19.0'));
  assert.ok(!atLeast('1.94.9', '1.95'));
});
