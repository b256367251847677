// The package: crates/wasm -> dist/wasm, web/lib and web/worker -> dist. The demo: web/app/dist.
import { existsSync, readFileSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { coreWasm, dist, drivesWasm, root, wasmTarget } from './lib/paths.mjs';
import { isMain, main, run } from './lib/run.mjs';
import { describeSize, sizes } from './lib/sizes.mjs';
import { whenChanged } from './lib/stamp.mjs';
import { setup } from './setup.mjs';

const say = (text) => console.log(`build: ${text}`);

// What rustc's wasm32 target turns on by itself, and SIMD (see .cargo/config.toml).
const wasmFeatures = [
  'simd', 'bulk-memory', 'mutable-globals', 'multivalue', 'nontrapping-float-to-int', 'reference-types', 'sign-ext',
].map((name) => `--enable-${name}`);

/** The modules: the feature of crates/wasm that each is made of, and its name in dist/wasm. */
const modules = { core: 'boresight', drives: 'boresight_drives' };

async function wasm() {
  const inputs = ['Cargo.toml', 'Cargo.lock', '.cargo/config.toml', 'crates', 'scripts/build.mjs'];
  const outputs = Object.values(modules).flatMap((name) => ['.js', '.d.ts', '_bg.wasm'].map((end) => `dist/wasm/${name}${end}`));
  const done = await whenChanged('wasm', { inputs, outputs }, async () => {
    for (const [feature, name] of Object.entries(modules)) {
      say(`crates/wasm -> dist/wasm/${name}_bg.wasm (a first build takes minutes)`);
      const file = join(dist, 'wasm', `${name}_bg.wasm`);
      await run('cargo', [
        'build', '-p', 'boresight-wasm', '--no-default-features', '--features', feature, '--release',
        '--target', wasmTarget, '--target-dir', join(root, 'target'),
      ]);
      // wasm-pack cannot pass on the last flag, which makes the instance replaceable after a trap.
      await run('wasm-bindgen', [
        join(root, 'target', wasmTarget, 'release', 'boresight_wasm.wasm'), '--target', 'web', '--out-dir', join(dist, 'wasm'),
        '--out-name', name, '--omit-default-module-path', '--experimental-reset-state-function',
      ]);
      say('wasm-opt -O3');
      await run(process.execPath, [
        join(root, 'node_modules', 'binaryen', 'bin', 'wasm-opt'), '-O3', ...wasmFeatures, file, '-o', file,
      ]);
    }
  });
  if (!done) say('dist/wasm is up to date');
}

async function library() {
  const inputs = ['package-lock.json', 'tsconfig.base.json', 'tsconfig.lib.json', 'web/lib', 'web/worker', 'dist/wasm/boresight.d.ts', 'dist/wasm/boresight_drives.d.ts'];
  const outputs = ['dist/lib/index.js', 'dist/lib/index.d.ts'];
  const done = await whenChanged('library', { inputs, outputs }, async () => {
    say('web/lib, web/worker -> dist (tsc)');
    for (const folder of ['lib', 'worker']) rmSync(join(dist, folder), { recursive: true, force: true });
    await run('tsc', ['-p', 'tsconfig.lib.json']);
  });
  if (!done) say('dist/lib, dist/worker are up to date');
}

export async function buildPackage() {
  await wasm();
  await library();
  say(describeSize('dist/wasm/boresight_bg.wasm', sizes(readFileSync(coreWasm))));
  say(describeSize('dist/wasm/boresight_drives_bg.wasm', sizes(readFileSync(drivesWasm))));
}

export async function buildDemo() {
  const inputs = ['package-lock.json', 'vite.config.ts', 'web', 'recordings', 'models', 'docs/experiments', 'dist/wasm', 'dist/lib', 'dist/worker'];
  const outputs = ['web/app/dist/index.html'];
  const done = await whenChanged('demo', { inputs, outputs }, async () => {
    say('web/app -> web/app/dist (vite)');
    await run('vite', ['build', '--logLevel', 'warn']);
  });
  if (!done) say('web/app/dist is up to date');
}

export async function build() {
  await setup();
  await buildPackage();
  if (existsSync(join(root, 'web', 'app', 'index.html'))) await buildDemo();
}

if (isMain(import.meta)) await main(build);
