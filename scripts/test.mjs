// Sets up, builds and runs every test. `npm test -- --only rust,node` runs some steps; their names
// are in the closing table. Nothing is skipped where CI=true.
import { mkdirSync, readdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import {
  buildDemo,
  buildPackage,
  buildReference,
  cargoArguments,
  core,
  crateArguments,
  drives,
  neural,
} from './build.mjs';
import { browserMissing, findBrowser } from './lib/browser.mjs';
import { environment, root } from './lib/paths.mjs';
import { main, runTee } from './lib/run.mjs';
import { cargoCounts, checkCounts, nodeCounts, summary } from './lib/summary.mjs';
import { setup } from './setup.mjs';

const node = process.execPath;
// A step that hangs is ended and has failed.
const longestStepMs = 30 * 60_000;
const clippy = (...args) => ['cargo', 'clippy', '--quiet', ...args, '--', '-D', 'warnings'];
/**
 * Tests in Node of all crates of bindings at once, so that what they share is compiled once. The runner writes CommonJS into
 * a temporary folder, which a package.json above it may say is not.
 */
const wasmTests = {
  name: 'wasm',
  command: () => {
    const folder = join(root, 'target', 'wasm-tests');
    mkdirSync(folder, { recursive: true });
    writeFileSync(join(folder, 'package.json'), '{ "type": "commonjs" }\n');
    const packages = ['wasm', 'wasm-neural'].flatMap((name) => ['-p', `boresight-${name}`]);
    return ['wasm-pack', '--log-level', 'error', 'test', '--node', '--mode', 'no-install', 'crates/wasm', ...packages];
  },
  variables: { TMPDIR: join(root, 'target', 'wasm-tests') },
  counts: cargoCounts,
};
const script = (name) => ({ name, command: [node, `scripts/${name}.mjs`], counts: checkCounts });

/** Test files of a folder, named one by one: what a folder means to `node --test` depends on its version. */
function nodeTests(folder, ...options) {
  const files = readdirSync(join(root, folder), { recursive: true })
    .filter((name) => name.endsWith('.test.mjs'))
    .map((name) => `${folder}/${name}`)
    .sort();
  return [node, '--test', '--test-reporter=spec', ...options, ...files];
}

/** Tests of pages, by two processes that each keep one browser. */
const browserTests = [
  node,
  '--test',
  '--test-reporter=spec',
  '--test-concurrency=2',
  'tests/browser/first-half.mjs',
  'tests/browser/second-half.mjs',
];

const steps = [
  { name: 'format', command: ['cargo', 'fmt', '--all', '--check'], counts: checkCounts },
  { name: 'lint', command: ['biome', 'check', '--error-on-warnings'], counts: checkCounts },
  { name: 'clippy', command: clippy('--all-targets'), counts: checkCounts },
  // The modules with their features. Core and drives are checked as they are built, for WebAssembly and with their profile, so
  // that all share what is compiled for the host. That of networks is checked natively, where most of what it depends on has
  // been: nothing of it differs for WebAssembly.
  ...[core, drives].map((module) => ({
    name: `clippy-${module.feature}`,
    command: clippy(...cargoArguments(module)),
    counts: checkCounts,
  })),
  { name: 'clippy-neural', command: clippy(...crateArguments(neural)), counts: checkCounts },
  {
    name: 'doc',
    command: ['cargo', 'doc', '--no-deps', '--quiet'],
    variables: { RUSTDOCFLAGS: '-D warnings' },
    counts: checkCounts,
  },
  {
    // Without libFuzzer, which needs a compiler of C++ and is linked only where fuzzing is done.
    name: 'fuzz',
    command: clippy('--manifest-path', 'fuzz/Cargo.toml', '--locked', '--features', 'network,fleet'),
    variables: { CUSTOM_LIBFUZZER_PATH: '/none/libnone.a', CARGO_TARGET_DIR: join(root, 'target') },
    counts: checkCounts,
  },
  script('check-dependencies'),
  script('check-licences'),
  script('check-workflows'),
  { name: 'scripts', command: () => nodeTests('tests/scripts'), counts: nodeCounts },
  { name: 'rust', command: [node, 'scripts/test-rust.mjs'], counts: cargoCounts },
  wasmTests,
  { name: 'build', work: buildPackage, counts: checkCounts },
  script('check-size'),
  script('check-simd'),
  { name: 'build-reference', work: buildReference, counts: checkCounts },
  { name: 'build-demo', work: buildDemo, counts: checkCounts },
  { name: 'types', command: ['tsc', '-p', 'tsconfig.json'], counts: checkCounts },
  { name: 'node', command: () => nodeTests('tests/node'), counts: nodeCounts },
  { name: 'packaging', command: () => nodeTests('tests/packaging', '--test-concurrency=1'), counts: nodeCounts },
  { name: 'browser', command: browserTests, counts: nodeCounts },
];

async function runStep({ command, work, variables, counts }) {
  const started = performance.now();
  let result;
  if (work) {
    result = await work().then(
      () => ({ ok: true, text: '' }),
      ({ message }) => {
        console.error(message);
        return { ok: false, text: '' };
      },
    );
  } else {
    const [program, ...args] = typeof command === 'function' ? command() : command;
    result = await runTee(program, args, { timeout: longestStepMs, env: { ...environment, ...variables } });
  }
  const counted = counts(result.text, result.ok);
  // A step that fails without a failed test (it did not compile, it was ended) is a failure too;
  // so is one that ran no test at all.
  const silent = counted.failed === 0 && (!result.ok || counted.passed + counted.skipped === 0);
  return { ...counted, failed: silent ? 1 : counted.failed, seconds: (performance.now() - started) / 1000 };
}

function chosenSteps(args) {
  const at = args.indexOf('--only');
  if (at < 0) return steps;
  const names = (args[at + 1] ?? '').split(',');
  const unknown = names.filter((name) => !steps.some((step) => step.name === name));
  if (unknown.length > 0) {
    throw new Error(`no step ${unknown.join(', ')}; there are ${steps.map(({ name }) => name).join(', ')}`);
  }
  return steps.filter(({ name }) => names.includes(name));
}

await main(async () => {
  const chosen = chosenSteps(process.argv.slice(2));
  const inCi = Boolean(process.env.CI);
  await setup({ wasmPack: true });
  const results = [];
  for (const step of chosen) {
    console.log(`\n=== ${step.name}`);
    results.push({ name: step.name, ...(await runStep(step)) });
  }
  const total = (key) => results.reduce((sum, result) => sum + result[key], 0);
  if (!findBrowser()) console.log(`\nBrowser tests did not run: ${browserMissing}`);
  console.log(`\n${summary(results)}`);
  if (total('failed') > 0 || (inCi && total('skipped') > 0)) process.exitCode = 1;
});
