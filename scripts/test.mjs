// Sets up, builds and tests in three tiers: `npm test` (what a change needs), `npm run check` (lints, docs, licences, sizes) and
// `npm run test:all` (both and everything else). `-- --only rust,node` runs some steps, `-- --rest` leaves out those of
// `npm test`; names are in the closing table. Where CI=true, a skipped test is a failure.
import { mkdirSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { parseArgs } from 'node:util';
import {
  buildDemo,
  buildForTests,
  buildPackage,
  buildReference,
  cargoArguments,
  core,
  crateArguments,
  drives,
  neural,
} from './build.mjs';
import { browserMissing, findBrowser } from './lib/browser.mjs';
import { environment, root, wasmTarget } from './lib/paths.mjs';
import { main, runKeeping, runTee } from './lib/run.mjs';
import { cargoCounts, checkCounts, nodeCounts, passedOnRetry, summary } from './lib/summary.mjs';
import { setup } from './setup.mjs';

const node = process.execPath;
const { scripts } = JSON.parse(readFileSync(join(root, 'package.json'), 'utf8'));
// A step that hangs is ended and has failed.
const longestStepMs = 30 * 60_000;
const clippy = (...args) => ['cargo', 'clippy', '--quiet', ...args, '--', '-D', 'warnings'];
/** A step that compiles Rust code. Such steps run one after another in the background, in parallel with the others. */
const inBackground = (step) => ({ ...step, background: true });

/** A step that needs both cores, for pages or for measurements. It waits until the background is idle. */
const alone = (step) => ({ ...step, alone: true });

/** Tests of the bindings in Node, with the runner set in .cargo/config.toml. */
const wasmTests = {
  name: 'wasm',
  command: ['cargo', 'test', '--target', wasmTarget, '-p', 'boresight-wasm', '--tests'],
  counts: cargoCounts,
};

/**
 * Tests of the network bindings. They are separate because they compile tract for WebAssembly in the test profile. The runner
 * writes CommonJS into a temporary folder, which needs a package.json that says so.
 */
const wasmNeuralTests = inBackground({
  name: 'wasm-neural',
  command: () => {
    const folder = join(root, 'target', 'wasm-tests');
    mkdirSync(folder, { recursive: true });
    writeFileSync(join(folder, 'package.json'), '{ "type": "commonjs" }\n');
    return ['wasm-pack', '--log-level', 'error', 'test', '--node', '--mode', 'no-install', 'crates/wasm-neural'];
  },
  variables: { TMPDIR: join(root, 'target', 'wasm-tests') },
  counts: cargoCounts,
});
const script = (name) => ({ name, command: [node, `scripts/${name}.mjs`], counts: checkCounts });

/** Test files of a folder, named one by one: what a folder means to `node --test` depends on its version. */
function nodeTests(folder, ...options) {
  const files = readdirSync(join(root, folder), { recursive: true })
    .filter((name) => name.endsWith('.test.mjs'))
    .map((name) => `${folder}/${name}`)
    .sort();
  return [node, '--test', '--test-reporter=spec', ...options, ...files];
}

/** All tests of pages but the flows, which `npm test` runs. BROWSER_SHARD=1/3 takes a third of the files. */
function browserTests() {
  const [program, ...args] = nodeTests('tests/browser', '--test-concurrency=2');
  const shard = process.env.BROWSER_SHARD ? [`--test-shard=${process.env.BROWSER_SHARD}`] : [];
  return [program, ...shard, ...args.filter((argument) => !argument.includes('/flows/'))];
}

/** A script of package.json, all of which Node runs; its arguments follow. */
const npm = (name, ...args) => ({
  name,
  command: [...scripts[name].split(' ').with(0, node), ...args],
  counts: checkCounts,
});

const build = { name: 'build', work: buildPackage, counts: checkCounts };

/** Needs no set-up either. */
const rustTests = inBackground({ name: 'rust', command: [node, 'scripts/test-rust.mjs'], counts: cargoCounts });

/** Crates with tests that have a smaller default size (tests/support/size.rs). */
const fullRustTests = inBackground({
  name: 'rust-full',
  command: [
    node,
    'scripts/test-rust.mjs',
    '--only',
    ['aoa', 'fleet', 'formats', 'mounting', 'neural'].map((name) => `crates/${name}`).join(),
  ],
  variables: { BORESIGHT_FULL: '1' },
  counts: cargoCounts,
});

/** The test in Node that has a smaller default size. */
const fullNodeTests = {
  name: 'node-full',
  command: [node, '--test', 'tests/node/hostile.test.mjs'],
  variables: { BORESIGHT_FULL: '1' },
  counts: nodeCounts,
};

/** `npm test`: what a change of code needs. */
const test = [
  rustTests,
  { name: 'build-quick', work: buildForTests, counts: checkCounts },
  wasmTests,
  { name: 'node', command: () => nodeTests('tests/node'), counts: nodeCounts },
  { name: 'flows', command: () => nodeTests('tests/browser/flows', '--test-concurrency=2'), counts: nodeCounts },
];

/** `npm run check`: everything that is read rather than run. */
const check = [
  // Types and sizes are those of what was built.
  build,
  { name: 'format', command: ['cargo', 'fmt', '--all', '--check'], counts: checkCounts },
  { name: 'lint', command: ['biome', 'check', '--error-on-warnings'], counts: checkCounts },
  inBackground({ name: 'clippy', command: clippy('--workspace', '--all-targets'), counts: checkCounts }),
  // Core and drives are checked for WebAssembly, with the profile of their build, so that compiled dependencies are shared.
  ...[core, drives].map((module) =>
    inBackground({
      name: `clippy-${module.feature}`,
      command: clippy(...cargoArguments(module)),
      counts: checkCounts,
    }),
  ),
  // Nothing of the module of networks differs between WebAssembly and the host, whose dependencies `clippy` has compiled.
  inBackground({ name: 'clippy-neural', command: clippy(...crateArguments(neural)), counts: checkCounts }),
  inBackground({
    // Without libFuzzer, which needs a C++ compiler and is linked only for fuzzing.
    name: 'clippy-fuzz',
    command: clippy('--manifest-path', 'fuzz/Cargo.toml', '--locked', '--features', 'network,fleet'),
    variables: { CUSTOM_LIBFUZZER_PATH: '/none/libnone.a', CARGO_TARGET_DIR: join(root, 'target') },
    counts: checkCounts,
  }),
  inBackground({
    name: 'doc',
    command: ['cargo', 'doc', '--no-deps', '--quiet'],
    variables: { RUSTDOCFLAGS: '-D warnings' },
    counts: checkCounts,
  }),
  script('check-dependencies'),
  script('check-licences'),
  script('check-workflows'),
  { name: 'scripts', command: () => nodeTests('tests/scripts'), counts: nodeCounts },
  { name: 'types', command: ['tsc', '-p', 'tsconfig.json'], counts: checkCounts },
  script('check-size'),
  script('check-simd'),
  npm('check:python'),
];

/** The rest of `npm run test:all`. */
const rest = [
  fullRustTests,
  fullNodeTests,
  wasmNeuralTests,
  { name: 'build-reference', work: buildReference, counts: checkCounts },
  { name: 'build-demo', work: buildDemo, counts: checkCounts },
  inBackground(npm('test:research')),
  { name: 'packaging', command: () => nodeTests('tests/packaging', '--test-concurrency=1'), counts: nodeCounts },
  npm('test:interop'),
  npm('test:python'),
  npm('test:notebooks'),
  npm('test:training'),
  npm('check:lighthouse', '--accessibility'),
  alone({ name: 'browser', command: browserTests, counts: nodeCounts }),
  // Ratios within one run, against those of an earlier one, with room for three times the noise.
  alone(npm('bench', '--quick', '--against', 'bench/baseline.json')),
];

const tiers = { test, check, all: [...new Set([...test, ...check, ...rest])] };

/** The steps that the arguments name: a tier, `--only NAMES`, `--rest` for those that are not in `npm test`. */
function chosenSteps(args) {
  const { values, positionals } = parseArgs({
    args,
    allowPositionals: true,
    options: { only: { type: 'string' }, rest: { type: 'boolean' } },
  });
  const [tier = 'test'] = positionals;
  const steps = tiers[tier];
  if (!steps) throw new Error(`no tier ${tier}; there are ${Object.keys(tiers).join(', ')}`);
  if (values.only === undefined) return values.rest ? steps.filter((step) => !test.includes(step)) : steps;
  const names = values.only.split(',');
  const unknown = names.filter((name) => !tiers.all.some((step) => step.name === name));
  if (unknown.length > 0) {
    throw new Error(`no step ${unknown.join(', ')}; there are ${tiers.all.map(({ name }) => name).join(', ')}`);
  }
  return tiers.all.filter(({ name }) => names.includes(name));
}

/** Runs a step. Its output is shown at once, or at its end if it runs in the background. */
async function runStep({ name, command, work, variables, counts, background = false }) {
  const started = performance.now();
  const title = `\n=== ${name}`;
  if (!background) console.log(title);
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
    const options = { timeout: longestStepMs, env: { ...environment, ...variables } };
    result = await (background ? runKeeping : runTee)(program, args, options);
    if (background) console.log(`${title}, in the background of the steps above\n${result.text}`);
  }
  const counted = counts(result.text, result.ok);
  // A step that fails without a failed test (it did not compile, it was ended) is a failure too;
  // so is one that ran no test at all.
  const silent = counted.failed === 0 && (!result.ok || counted.passed + counted.skipped === 0);
  return {
    name,
    ...counted,
    failed: silent ? 1 : counted.failed,
    seconds: (performance.now() - started) / 1000,
    retried: passedOnRetry(result.text),
  };
}

/** Runs steps one after another. All but the Rust tests wait for `ready`. */
async function runSteps(steps, ready) {
  const results = [];
  for (const step of steps) {
    if (step !== rustTests) await ready(step);
    results.push(await runStep(step));
  }
  return results;
}

await main(async () => {
  const chosen = chosenSteps(process.argv.slice(2));
  const inCi = Boolean(process.env.CI);
  const started = performance.now();
  const others = chosen.filter((step) => !step.background);
  // Without other steps, output is shown at once.
  const queue = others.length > 0 ? chosen.filter((step) => step.background) : [];
  if (queue.length > 0) {
    const names = queue.map(({ name }) => name).join(', ');
    console.log(`${names}: run in the background; the output of each is shown at its end`);
  }
  const prepared = setup({ wasmPack: chosen.includes(wasmNeuralTests) });
  const queued = runSteps(queue, () => prepared);
  const inTurn = others.length > 0 ? others : chosen.map((step) => ({ ...step, background: false }));
  const turns = runSteps(inTurn, (step) => Promise.all([prepared, step.alone && queued]));
  const finished = (await Promise.all([turns, queued])).flat();
  const results = chosen.map(({ name }) => finished.find((result) => result.name === name));
  const total = (key) => results.reduce((sum, result) => sum + result[key], 0);
  if (!findBrowser()) console.log(`\nBrowser tests did not run: ${browserMissing}`);
  for (const name of results.flatMap(({ retried }) => retried)) console.log(`\nPassed only on the second try: ${name}`);
  console.log(`\nAll steps took ${((performance.now() - started) / 1000).toFixed(0)} s.`);
  console.log(`\n${summary(results)}`);
  if (total('failed') > 0 || (inCi && total('skipped') > 0)) process.exitCode = 1;
});
