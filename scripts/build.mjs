// The package: crates/wasm, crates/wasm-neural -> dist/wasm, web/lib and web/worker -> dist. The demo: web/app/dist.
import { existsSync, readFileSync, rmSync } from 'node:fs';
import { join, relative } from 'node:path';
import { coreWasm, dist, drivesWasm, neuralWasm, root, wasmTarget } from './lib/paths.mjs';
import { isMain, main, run } from './lib/run.mjs';
import { describeSize, sizes } from './lib/sizes.mjs';
import { whenChanged } from './lib/stamp.mjs';
import { setup } from './setup.mjs';

const say = (text) => console.log(`build: ${text}`);

// What rustc's wasm32 target turns on by itself, and SIMD (see .cargo/config.toml).
const wasmFeatures = [
  'simd',
  'bulk-memory',
  'mutable-globals',
  'multivalue',
  'nontrapping-float-to-int',
  'reference-types',
  'sign-ext',
].map((name) => `--enable-${name}`);

/** Crates that a module of them only depends on: their changes do not touch the others. */
const crates = (...names) => names.map((name) => `crates/${name}`);
const shared = crates(
  'aoa',
  'calibrate',
  'core',
  'derive',
  'formats',
  'image',
  'pipeline',
  'signal',
  'simulate',
  'wasm',
);

/** The modules: name in dist/wasm, crate, feature, profile, the crates it is made of. */
export const modules = [
  { name: 'boresight', crate: 'wasm', feature: 'core', profile: 'dist', made: shared },
  { name: 'boresight_drives', crate: 'wasm', feature: 'drives', profile: 'dist', made: shared },
  {
    name: 'boresight_neural',
    crate: 'wasm-neural',
    profile: 'neural',
    made: [...shared, ...crates('neural', 'wasm-neural')],
  },
];

/** Arguments that tell cargo which module is meant. */
export const cargoArguments = ({ crate, feature, profile }) => [
  '-p',
  `boresight-${crate}`,
  ...(feature ? ['--no-default-features', '--features', feature] : []),
  '--target',
  wasmTarget,
  '--profile',
  profile,
];

async function wasmModule(module) {
  const { name, crate, profile, made } = module;
  const inputs = ['Cargo.toml', 'Cargo.lock', '.cargo/config.toml', ...made, 'scripts/build.mjs'];
  const outputs = ['.js', '.d.ts', '_bg.wasm'].map((end) => `dist/wasm/${name}${end}`);
  const done = await whenChanged(name, { inputs, outputs }, async () => {
    say(`crates/${crate} -> dist/wasm/${name}_bg.wasm (a first build takes minutes)`);
    const file = join(dist, 'wasm', `${name}_bg.wasm`);
    const targetDir = join(root, 'target');
    await run('cargo', ['build', ...cargoArguments(module), '--target-dir', targetDir]);
    // wasm-pack cannot pass on the last flag, which makes the instance replaceable after a trap.
    await run('wasm-bindgen', [
      join(root, 'target', wasmTarget, profile, `boresight_${crate.replace('-', '_')}.wasm`),
      '--target',
      'web',
      '--out-dir',
      join(dist, 'wasm'),
      '--out-name',
      name,
      '--omit-default-module-path',
      '--experimental-reset-state-function',
    ]);
    // Of the module of networks it would take minutes.
    if (profile === 'neural') return;
    say('wasm-opt -O3');
    await run(process.execPath, [
      join(root, 'node_modules', 'binaryen', 'bin', 'wasm-opt'),
      '-O3',
      ...wasmFeatures,
      file,
      '-o',
      file,
    ]);
  });
  if (!done) say(`dist/wasm/${name}_bg.wasm is up to date`);
}

async function library() {
  const glue = modules.map(({ name }) => `dist/wasm/${name}.d.ts`);
  const inputs = ['package-lock.json', 'tsconfig.base.json', 'tsconfig.lib.json', 'web/lib', 'web/worker', ...glue];
  const outputs = ['dist/lib/index.js', 'dist/lib/index.d.ts'];
  const done = await whenChanged('library', { inputs, outputs }, async () => {
    say('web/lib, web/worker -> dist (tsc)');
    for (const folder of ['lib', 'worker']) rmSync(join(dist, folder), { recursive: true, force: true });
    await run('tsc', ['-p', 'tsconfig.lib.json']);
  });
  if (!done) say('dist/lib, dist/worker are up to date');
}

export async function buildPackage() {
  for (const one of modules) await wasmModule(one);
  await library();
  for (const file of [coreWasm, drivesWasm, neuralWasm])
    say(describeSize(relative(root, file), sizes(readFileSync(file))));
}

export async function buildDemo() {
  const inputs = [
    'package-lock.json',
    'vite.config.ts',
    'web',
    'recordings',
    'models',
    'docs/experiments',
    'dist/wasm',
    'dist/lib',
    'dist/worker',
  ];
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
