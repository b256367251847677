// Measures the way from a fresh clone of the commit checked out to the demo, the command line and the tests, each from
// nothing but what the registries give, and fails where one takes longer than its target. `--only start,cli,test,edit`
// measures some; `--cold` downloads crates and packages anew; `--keep` leaves the folder. Takes an hour and a half, on
// Linux or macOS; times mean something where nothing else runs.
import { spawn } from 'node:child_process';
import { closeSync, existsSync, mkdirSync, mkdtempSync, openSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { cpus, homedir, loadavg, tmpdir } from 'node:os';
import { delimiter, join } from 'node:path';
import { setTimeout as delay } from 'node:timers/promises';
import { freePort } from './lib/free-port.mjs';
import { root } from './lib/paths.mjs';
import { main, output, run } from './lib/run.mjs';
import { edited, MEASURES, mainScript, processorSeconds, settings, table, verdict } from './lib/setup-measures.mjs';

const LONGEST_MS = 60 * 60_000;
const { only, cold, keep } = settings(process.argv.slice(2));
const commit = output('git', ['rev-parse', 'HEAD'])?.trim();
const folder = mkdtempSync(join(tmpdir(), 'boresight-setup-'));
const environment = { ...process.env, NO_COLOR: '1' };
for (const name of ['CI', 'CARGO_TARGET_DIR', 'CARGO_BUILD_TARGET_DIR', 'RUSTFLAGS', 'BORESIGHT_WITHOUT_NETWORKS'])
  delete environment[name];
// npm puts the programs of this checkout first.
environment.PATH = process.env.PATH.split(delimiter)
  .filter((path) => !path.includes('node_modules'))
  .join(delimiter);

/** Commands under way, each the head of a process group of its own. */
const under = new Set();
let isEnding = false;
const measured = [];

function freshRegistries() {
  const home = join(folder, 'cargo');
  mkdirSync(home);
  // Where the registries are is not part of what is downloaded.
  for (const name of ['config.toml', 'config']) {
    const file = join(process.env.CARGO_HOME ?? join(homedir(), '.cargo'), name);
    if (existsSync(file)) writeFileSync(join(home, name), readFileSync(file));
  }
  Object.assign(environment, { CARGO_HOME: home, npm_config_cache: join(folder, 'npm') });
}

/** A checkout of its own. */
async function clone(name) {
  const path = join(folder, name);
  await run('git', ['clone', '--quiet', '--no-checkout', root, path]);
  await run('git', ['-C', path, '-c', 'advice.detachedHead=false', 'checkout', '--quiet', commit]);
  return path;
}

/** Starts a command whose output goes into a log; `done` resolves with what went wrong, if something did. */
function start(cwd, command, args) {
  if (isEnding) throw new Error('interrupted');
  const log = join(folder, `${command}-${Date.now()}.log`);
  const file = openSync(log, 'w');
  const child = spawn(command, args, {
    cwd,
    env: environment,
    stdio: ['ignore', file, file],
    detached: true,
  });
  closeSync(file);
  const done = new Promise((resolve) => {
    child.once('error', ({ message }) => resolve(message));
    child.once('close', (code, signal) => resolve(code === 0 ? undefined : `ended with ${signal ?? `status ${code}`}`));
  }).finally(() => under.delete(running));
  const running = { child, done, said: () => readFileSync(log, 'utf8') };
  under.add(running);
  return running;
}

/** Ends a command with all that it started. */
async function stop(running) {
  if (under.has(running) && running.child.pid) process.kill(-running.child.pid);
  await running.done;
}

/** Measures from now on; calling what it gives takes the time, and again with a later time too. */
function watch() {
  const began = performance.now();
  const worked = processorSeconds(cpus());
  return (name, problem, said = '') => {
    const seconds = (performance.now() - began) / 1000;
    const one = { ...MEASURES.find((measure) => measure.name === name), seconds, problem };
    measured.push({ ...one, cpuSeconds: processorSeconds(cpus()) - worked });
    console.log(`measure: ${name}: ${seconds.toFixed(1)} s${problem ? `: ${problem}` : ''}`);
    if (problem) console.log(said.trimEnd().split('\n').slice(-40).join('\n'));
  };
}

async function measureCommand(name, cwd, command, args) {
  const take = watch();
  const running = start(cwd, command, args);
  const timer = setTimeout(() => void stop(running), LONGEST_MS);
  const problem = await running.done;
  clearTimeout(timer);
  take(name, problem, running.said());
}

const [SERVED, READY, CLI, FIRST_TEST, SECOND_TEST, EDIT] = MEASURES.map(({ name }) => name);

const answers = async (address) => {
  try {
    const response = await fetch(address);
    return response.ok ? await response.text() : null;
  } catch {
    return null;
  }
};

/** Whether the demo is there: its page, and the script that the page names. */
async function served(address) {
  const page = await answers(address);
  const script = page === null ? null : mainScript(page);
  return script !== null && (await answers(new URL(script, address))) !== null;
}

/** What of the networks is told to a page. */
async function networks(address) {
  try {
    return JSON.parse((await answers(new URL('/later/state.json', address))) ?? '{}');
  } catch {
    return {};
  }
}

async function measureStart() {
  const cwd = await clone('start');
  const port = await freePort();
  const address = `http://127.0.0.1:${port}/`;
  const take = watch();
  const running = start(cwd, 'npm', ['start', '--', '--host', '127.0.0.1', '--port', `${port}`, '--strictPort']);
  const until = async (there) => {
    for (const began = performance.now(); performance.now() - began < LONGEST_MS; await delay(200)) {
      if (!under.has(running)) return (await running.done) ?? 'it ended';
      const found = await there();
      if (found !== undefined) return found;
    }
    return 'it took an hour';
  };
  const first = await until(async () => ((await served(address)) ? null : undefined));
  take(SERVED, first ?? undefined, running.said());
  if (first === null) {
    const second = await until(async () => {
      const { state, reason } = await networks(address);
      if (state === 'ready') return null;
      return state === 'failed' ? reason : undefined;
    });
    take(READY, second ?? undefined, running.said());
  }
  await stop(running);
}

const measureCli = async () =>
  measureCommand(CLI, await clone('cli'), 'cargo', ['run', '--release', '-p', 'boresight-cli', '--', '--help']);

let tested;
async function measureTests() {
  tested = await clone('test');
  await measureCommand(FIRST_TEST, tested, 'npm', ['test']);
  await measureCommand(SECOND_TEST, tested, 'npm', ['test']);
}

async function measureEdit() {
  const cwd = tested ?? (await clone('edit'));
  const tests = ['test', '-p', 'boresight-aoa'];
  const before = start(cwd, 'cargo', tests);
  const problem = await before.done;
  if (problem) throw new Error(`the tests of crates/aoa ${problem} before anything was changed\n${before.said()}`);
  const file = join(cwd, 'crates', 'aoa', 'src', 'estimators', 'capon.rs');
  const source = readFileSync(file, 'utf8');
  writeFileSync(file, edited(source, Date.now()));
  await measureCommand(EDIT, cwd, 'cargo', tests);
  writeFileSync(file, source);
}

const measures = { start: measureStart, cli: measureCli, test: measureTests, edit: measureEdit };

async function cleanUp() {
  await Promise.all([...under].map(stop));
  // Those that a command started may end a little later.
  if (!keep) rmSync(folder, { recursive: true, force: true, maxRetries: 20, retryDelay: 200 });
}

for (const signal of ['SIGINT', 'SIGTERM'])
  process.once(signal, async () => {
    isEnding = true;
    await cleanUp();
    process.exit(1);
  });

await main(async () => {
  const load = loadavg()[0];
  console.log(`measure: commit ${commit}, ${cpus().length} cores, load ${load.toFixed(2)}, in ${folder}`);
  if (load > 0.5) console.log('measure: this machine is not idle, and times will say little');
  if (cold) freshRegistries();
  try {
    for (const part of only) await measures[part]();
  } finally {
    await cleanUp();
  }
  console.log(`\n${table(measured)}\n`);
  console.log('CPU seconds are those of the whole machine. Targets are for two idle cores.');
  const bad = measured.filter((one) => verdict(one) !== 'ok');
  if (bad.length > 0) throw new Error(bad.map((one) => `${verdict(one)}: ${one.name}`).join('\n'));
});
