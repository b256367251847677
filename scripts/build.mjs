// The package: crates/wasm, crates/wasm-neural -> dist/wasm, web/lib and web/worker -> dist, all in single files ->
// dist/inline, and with the elements in one module -> python/boresight-widget, in one script -> dist/foxglove. The demo:
// web/app/dist.
import { existsSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { foxeName, makeFoxglove } from './lib/build/foxglove.mjs';
import { makeInline } from './lib/build/inline.mjs';
import { manifest } from './lib/build/manifest.mjs';
import { makeNotebook, notebookFolder } from './lib/build/notebook.mjs';
import { npmTools } from './lib/build/npm-tools.mjs';
import { publish } from './lib/build/publish.mjs';
import { upToDate, whenChanged } from './lib/build/stamp.mjs';
import { dist, environment, root, wasmTarget } from './lib/paths.mjs';
import { isMain, main, run } from './lib/run.mjs';
import { setup } from './setup.mjs';

const targetDir = join(root, 'target');
const reference = 'dist/reference/index.html';
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

// The second round uses which values can flow where and reduces the Brotli size by 0.5 %; the order by name puts similar
// functions next to each other: another 0.7 %.
const wasmPasses = ['-Os', '--gufa', '-Os', '--reorder-functions-by-name'];

/** Manifests and sources of crates and of all crates of the workspace that they depend on, without optional ones. */
function withDependencies(...crates) {
  const found = new Set(crates);
  for (const crate of found) {
    const [dependencies] = readFileSync(join(root, 'crates', crate, 'Cargo.toml'), 'utf8').split('[dev-dependencies]');
    for (const [, name] of dependencies.matchAll(/^boresight-([\w-]+)\.workspace/gm))
      for (const path of [name, `options/${name}`]) if (existsSync(join(root, 'crates', path))) found.add(path);
  }
  return [...found].flatMap((name) => [`crates/${name}/Cargo.toml`, `crates/${name}/src`]);
}

export const core = { name: 'boresight', crate: 'wasm', feature: 'core', profile: 'dist', wasmOpt: true };
export const drives = { ...core, name: 'boresight_drives', feature: 'drives', optional: ['report'] };
/** Of networks. wasm-opt would take minutes. */
export const neural = {
  name: 'boresight_neural',
  crate: 'wasm-neural',
  profile: 'neural',
  wasmOpt: false,
};

/** The modules: name in dist/wasm, crate, feature, how it is built, the crates it is made of. */
const modules = [core, drives, neural];

/** How `npm start` builds the core and the drives, for which somebody waits: without what makes them a little faster. */
const QUICK = { profile: 'dist', wasmOpt: false };

/** Arguments that tell cargo which module's crate is meant, with which features. */
export const crateArguments = ({ crate, feature }) => [
  '-p',
  `boresight-${crate}`,
  ...(feature ? ['--no-default-features', '--features', feature] : []),
];

/** Those that tell it how a module is compiled, too. */
export const cargoArguments = (module) => [
  ...crateArguments(module),
  '--target',
  wasmTarget,
  '--profile',
  module.profile,
];

const form = ({ profile, wasmOpt }) => `${profile}${wasmOpt ? ', wasm-opt' : ''}`;
const outputs = ({ name }) => ['.js', '.d.ts', '_bg.wasm'].map((end) => `dist/wasm/${name}${end}`);
const stamp = (module, ...better) => ({
  inputs: [
    'Cargo.toml',
    'Cargo.lock',
    '.cargo/config.toml',
    ...withDependencies(module.crate, ...(module.optional ?? [])),
    'scripts/build.mjs',
  ],
  extra: [form(module)],
  better: better.map((one) => [form(one)]),
  outputs: outputs(module),
});

/** Whether a module stands as it is published. */
export const isBuilt = (module) => upToDate(module.name, stamp(module));

/** Builds a module as it is published; `runner` runs the commands, `compiling` says when it is its turn to be compiled. */
export async function buildModule(module, runner, compiling = (work) => work()) {
  const done = await whenChanged(module.name, stamp(module), async () => {
    await compiling(async () => {
      await compile(module, runner);
      await bind(module, runner);
    });
    await optimise(module, runner);
  });
  if (!done) sayStands(module);
}

/** Builds all modules: while one is made smaller, which is work for one core, the next is compiled. */
async function buildModules() {
  let before = Promise.resolve();
  await Promise.all(modules.map((one) => buildModule(one, run, (work) => (before = before.then(work)))));
}

/**
 * Builds what the page needs at once, quickly. `tools` is a promise of wasm-bindgen: the crates are compiled while it is,
 * and found compiled when it has come.
 */
export async function buildQuickly(tools) {
  const quick = [core, drives].map((published) => {
    const module = { ...published, ...QUICK };
    return { module, made: stamp(module, published) };
  });
  for (const { module, made } of quick) if (!upToDate(module.name, made)) await compile(module);
  await tools;
  for (const { module, made } of quick) {
    const done = await whenChanged(module.name, made, async () => {
      // Both are one file of cargo's, which is that of the last one compiled.
      await run('cargo', cargoBuild(module, '--quiet'));
      await bind(module);
      await optimise(module);
    });
    if (!done) sayStands(module);
  }
}

const sayStands = ({ name }) => say(`dist/wasm/${name}_bg.wasm is up to date`);
const cargoBuild = (module, ...more) => ['build', ...cargoArguments(module), '--target-dir', targetDir, ...more];

function compile(module, runner = run) {
  say(`crates/${module.crate} -> dist/wasm/${module.name}_bg.wasm (a first build takes minutes)`);
  return runner('cargo', cargoBuild(module));
}

async function bind({ name, crate, profile }, runner = run) {
  await runner('wasm-bindgen', [
    join(targetDir, wasmTarget, profile, `boresight_${crate.replace('-', '_')}.wasm`),
    '--target',
    'web',
    '--out-dir',
    join(dist, 'wasm'),
    '--out-name',
    name,
    '--omit-default-module-path',
    // Makes the instance replaceable after a trap (web/lib/runtime/module.ts).
    '--experimental-reset-state-function',
  ]);
}

async function optimise({ name, wasmOpt }, runner = run) {
  if (!wasmOpt) return;
  say(`wasm-opt of ${name}`);
  const file = join(dist, 'wasm', `${name}_bg.wasm`);
  const program = join(root, 'node_modules', 'binaryen', 'bin', 'wasm-opt');
  await runner(process.execPath, [program, ...wasmPasses, ...wasmFeatures, file, '-o', file]);
}

export async function buildLibrary() {
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

export async function buildElements() {
  const inputs = [
    'package-lock.json',
    'tsconfig.base.json',
    'tsconfig.json',
    'tsconfig.elements.json',
    'vite.elements.config.ts',
    'web/elements',
    'web/plots',
    'dist/lib/index.d.ts',
    'dist/worker/index.d.ts',
  ];
  const outputs = ['index.js', 'custom-elements.json', 'types/elements/index.d.ts'].map(
    (name) => `dist/elements/${name}`,
  );
  const done = await whenChanged('elements', { inputs, outputs }, async () => {
    say('web/elements -> dist/elements (vite, tsc)');
    await run('vite', ['build', '-c', 'vite.elements.config.ts', '--logLevel', 'warn']);
    await run('tsc', ['-p', 'tsconfig.elements.json']);
    writeFileSync(join(dist, 'elements', 'custom-elements.json'), `${JSON.stringify(await manifest(), null, 2)}\n`);
  });
  if (!done) say('dist/elements is up to date');
}

/** The package in single files (scripts/lib/build/inline.mjs). */
export async function buildInline() {
  const made = ({ name }) => [`dist/wasm/${name}.js`, `dist/wasm/${name}_bg.wasm`];
  const inputs = [
    'package-lock.json',
    ...['base', 'lib', 'inline'].map((name) => `tsconfig.${name}.json`),
    'scripts/lib/build/inline.mjs',
    'web/inline',
    'web/lib',
    'web/worker',
  ];
  const files = ['boresight', 'boresight.global', 'boresight.worker', 'networks'];
  const stamped = {
    inputs: [...inputs, ...modules.flatMap(made)],
    outputs: [...files.map((name) => `dist/inline/${name}.js`), 'dist/inline/boresight.d.ts'],
  };
  const done = await whenChanged('inline', stamped, async () => {
    say('web/inline, dist -> dist/inline (tsc, vite)');
    rmSync(join(dist, 'inline'), { recursive: true, force: true });
    await run('tsc', ['-p', 'tsconfig.inline.json']);
    await makeInline();
  });
  if (!done) say('dist/inline is up to date');
}

/** The API reference, from the types of the package (docs/reference). */
export async function buildReference() {
  const inputs = [
    'package-lock.json',
    'docs/reference',
    'dist/lib',
    'dist/worker',
    'dist/elements/types',
    'dist/inline',
  ];
  const done = await whenChanged('reference', { inputs, outputs: [reference] }, async () => {
    say('docs/reference -> dist/reference (typedoc)');
    // It reads types with a TypeScript of its own, which has the interface that it needs.
    const resolve = await npmTools('typedoc', { typedoc: '0.28.20', typescript: '6.0.3' });
    const program = join(dirname(resolve('typedoc/package.json')), 'bin', 'typedoc');
    await run(process.execPath, [program], { cwd: join(root, 'docs', 'reference') });
  });
  if (!done) say('dist/reference is up to date');
}

/** What the Python package of widgets holds (scripts/lib/build/notebook.mjs). */
export async function buildNotebook() {
  const inputs = [
    'package.json',
    'package-lock.json',
    'scripts/lib/build/notebook.mjs',
    'vite.notebook.config.ts',
    'web/elements',
    'web/notebook',
    'web/plots',
    'dist/elements/custom-elements.json',
    'dist/inline/boresight.js',
  ];
  const outputs = ['widget.js', 'elements.json', 'LICENSES.md'].map((name) => `${notebookFolder}/${name}`);
  const done = await whenChanged('notebook', { inputs, outputs }, async () => {
    say(`web/notebook, web/elements, dist/inline -> ${notebookFolder} (vite)`);
    await makeNotebook();
  });
  if (!done) say(`${notebookFolder} is up to date`);
}

/** The extension for Foxglove and Lichtblick (scripts/lib/build/foxglove.mjs). */
export async function buildFoxglove() {
  const inputs = [
    'package.json',
    'package-lock.json',
    'CHANGELOG.md',
    'LICENSE',
    'LICENSE-APACHE',
    'NOTICE',
    'scripts/lib/build/foxglove.mjs',
    'scripts/lib/build/inline.mjs',
    'web/elements',
    'web/foxglove',
    'web/inline',
    'web/messages',
    'web/plots',
    'dist/lib/index.d.ts',
    'dist/inline/boresight.js',
  ];
  const outputs = [`dist/foxglove/${foxeName()}`];
  const done = await whenChanged('foxglove', { inputs, outputs }, async () => {
    say(`web/foxglove -> ${outputs[0]} (vite)`);
    await makeFoxglove();
  });
  if (!done) say(`${outputs[0]} is up to date`);
}

export async function buildPackage() {
  await buildModules();
  await buildLibrary();
  await buildElements();
  await buildInline();
  await buildNotebook();
  await buildFoxglove();
}

/** What `npm test` needs: the modules as `npm start` builds them, or as published where those are up to date, and the demo. */
export async function buildForTests() {
  await buildQuickly(Promise.resolve());
  await buildModule(neural);
  await buildLibrary();
  await buildDemo();
}

/** `variables`: of the environment that vite.config.ts reads. */
export async function buildDemo(variables = {}) {
  const inputs = [
    'package-lock.json',
    'vite.config.ts',
    'scripts/lib/build/compressed.mjs',
    'scripts/lib/build/bundled-drive.mjs',
    'scripts/lib/build/manifest.mjs',
    'web/offline.ts',
    'web',
    'recordings',
    'models',
    ...['research/models', 'research/results'].filter((folder) => existsSync(join(root, folder))),
    'dist/wasm',
    'dist/lib',
    'dist/worker',
    reference,
  ];
  const outputs = ['web/app/dist/index.html'];
  const done = await whenChanged('demo', { inputs, extra: Object.keys(variables), outputs }, async () => {
    say('web/app -> web/app/dist (vite)');
    // A demo that is being served stays whole while the next is built.
    const app = join(root, 'web', 'app');
    const built = join(app, 'next', 'dist');
    await run('vite', ['build', '--logLevel', 'warn', '--outDir', built], { env: { ...environment, ...variables } });
    publish(built, join(app, 'dist'));
    rmSync(join(app, 'next'), { recursive: true });
  });
  if (!done) say('web/app/dist is up to date');
}

export async function build() {
  await setup();
  await buildPackage();
  await buildReference();
  if (existsSync(join(root, 'web', 'app', 'index.html'))) await buildDemo();
}

if (isMain(import.meta)) await main(build);
