// Runs the fuzz targets: `npm run fuzz -- --seconds 60 --only uart,hdf5`. A crash is kept under fuzz/regressions, where the
// tests find it, and the status is 1. Without a nightly compiler there is nothing to run.
import { createHash } from 'node:crypto';
import { copyFileSync, existsSync, mkdirSync, readdirSync, readFileSync } from 'node:fs';
import { availableParallelism } from 'node:os';
import { join, relative } from 'node:path';
import { parseArgs } from 'node:util';
import { parse } from 'smol-toml';
import { cargoTool } from './lib/cargo-tool.mjs';
import { fuzzCounts, fuzzTable } from './lib/checks/fuzz-counts.mjs';
import { root, tool } from './lib/paths.mjs';
import { main, output, run, runKeeping } from './lib/run.mjs';

const folder = join(root, 'fuzz');
const toolchain = 'nightly';
// No sanitizer: all unsafe code is in dependencies, and without one targets build and run several times as fast.
const options = ['--fuzz-dir', folder, '--sanitizer', 'none'];

/** Name and features of each target. */
function targets() {
  const { bin } = parse(readFileSync(join(folder, 'Cargo.toml'), 'utf8'));
  return bin.map(({ name, 'required-features': features = [] }) => ({ name, features }));
}

/** The targets of `--only`, or those that build without a feature, or all of them. */
function chosen({ only, all: everything }) {
  const all = targets();
  if (only === undefined) return all.filter(({ features }) => everything || features.length === 0);
  const names = only.split(',');
  const unknown = names.filter((name) => !all.some((target) => target.name === name));
  if (unknown.length > 0)
    throw new Error(`no fuzz target ${unknown.join(', ')}; there are ${all.map(({ name }) => name).join(', ')}`);
  return all.filter(({ name }) => names.includes(name));
}

const filesOf = (path) => (existsSync(path) ? readdirSync(path).map((name) => join(path, name)) : []);

/** Runs one target, and keeps what crashed it. */
async function fuzz(name, features, seconds) {
  const [corpus, artifacts, kept] = ['corpus', 'artifacts', 'regressions'].map((kind) => join(folder, kind, name));
  mkdirSync(corpus, { recursive: true });
  const inputs = [corpus, join(folder, 'seeds', name), kept].filter((path) => existsSync(path));
  const before = new Set(filesOf(artifacts));
  const limits = [`-max_total_time=${seconds}`, '-rss_limit_mb=2048', '-timeout=20', '-print_final_stats=1'];
  const started = performance.now();
  const args = [`+${toolchain}`, 'fuzz', 'run', ...options, ...features, name, ...inputs, '--', ...limits];
  const { ok, text } = await runKeeping('cargo', args);
  const crashes = filesOf(artifacts).filter((path) => !before.has(path));
  for (const path of crashes) {
    mkdirSync(kept, { recursive: true });
    const digest = createHash('sha256').update(readFileSync(path)).digest('hex').slice(0, 12);
    const copy = join(kept, `crash-${digest}`);
    copyFileSync(path, copy);
    console.log(`${name}: ${relative(root, copy)}\n${text.split('\n').slice(-40).join('\n')}`);
  }
  if (!ok && crashes.length === 0) throw new Error(`${name} did not run:\n${text.split('\n').slice(-40).join('\n')}`);
  const lasted = (performance.now() - started) / 1000;
  return { name, ...fuzzCounts(text, lasted), corpus: filesOf(corpus).length, crashes: crashes.length };
}

await main(async () => {
  const { values } = parseArgs({
    options: { seconds: { type: 'string', default: '60' }, only: { type: 'string' }, all: { type: 'boolean' } },
  });
  const seconds = Number(values.seconds);
  if (!Number.isInteger(seconds) || seconds < 1)
    throw new Error(`--seconds is ${values.seconds}; expected a whole number from 1`);
  const wanted = chosen(values);
  if (output('cargo', [`+${toolchain}`, '--version']) === null) {
    console.log('Fuzz targets did not run: they need a nightly compiler (rustup toolchain install nightly)');
    return;
  }
  await cargoTool('cargo-fuzz', 'cargo-fuzz', '0.13.2');
  console.log(`${tool('cargo-fuzz')}: building ${wanted.length} targets`);
  const named = [...new Set(wanted.flatMap(({ features }) => features))];
  const features = named.length > 0 ? ['--features', named.join(',')] : [];
  const alone = wanted.length === 1 ? [wanted[0].name] : [];
  const started = performance.now();
  await run('cargo', [`+${toolchain}`, 'fuzz', 'build', ...options, ...features, ...alone]);
  console.log(`built in ${((performance.now() - started) / 1000).toFixed(0)} s`);
  // As many targets at a time as there are cores: each uses one.
  const results = [];
  const waiting = [...wanted.entries()];
  const worker = async () => {
    for (let one = waiting.shift(); one; one = waiting.shift()) {
      const [at, { name }] = one;
      results[at] = await fuzz(name, features, seconds);
      console.log(`${name}: ${results[at].runs} runs`);
    }
  };
  await Promise.all(Array.from({ length: availableParallelism() }, worker));
  console.log(`\n${fuzzTable(results)}`);
  const crashes = results.reduce((sum, result) => sum + result.crashes, 0);
  if (crashes > 0) throw new Error(`${crashes} crashes; their inputs are in fuzz/regressions`);
});
