// Introduces ten mistakes, one at a time, in a clone of the current commit, and reports which of them the tests detect
// (scripts/lib/mutations.mjs lists mistakes and tests). Fails if `npm test` detects fewer than eight, or
// `npm run test:all` not all. `--only TEXT` selects mistakes by name; `--clone FOLDER` keeps the clone and its build outputs there for the next
// run. Takes half an hour.
import { spawnSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { parseArgs } from 'node:util';
import { MUTATIONS, mutated } from './lib/mutations.mjs';
import { root } from './lib/paths.mjs';
import { main, output, run, runKeeping } from './lib/run.mjs';

/** Share of the mistakes that `npm test` has to detect. */
const QUICK_SHARE = 0.8;

const { values } = parseArgs({ options: { only: { type: 'string', default: '' }, clone: { type: 'string' } } });

async function checkout() {
  const commit = output('git', ['rev-parse', 'HEAD'])?.trim();
  const folder = values.clone ? resolve(values.clone) : mkdtempSync(join(tmpdir(), 'boresight-mutations-'));
  if (!existsSync(join(folder, '.git'))) await run('git', ['clone', '--quiet', root, folder]);
  const origin = output('git', ['-C', folder, 'remote', 'get-url', 'origin'])?.trim();
  if (!origin || resolve(origin) !== resolve(root)) throw new Error(`${folder} is not a clone of ${root}`);
  if (spawnSync('git', ['-C', folder, 'diff', '--quiet', 'HEAD']).status !== 0) {
    throw new Error(`${folder} has changes that are not committed`);
  }
  await run('git', ['-C', folder, 'fetch', '--quiet', root, 'HEAD']);
  await run('git', ['-C', folder, '-c', 'advice.detachedHead=false', 'checkout', '--quiet', commit]);
  return folder;
}

/** Runs commands in the clone until one fails. Returns that command and its first error line, or null. */
async function failure(folder, commands = []) {
  for (const command of commands) {
    const [program, ...args] = command;
    const { ok, text } = await runKeeping(program, args, { cwd: folder });
    if (ok) continue;
    const first = /^.*(?:✖|panicked at|^error\b).*$/m.exec(text)?.[0] ?? text.trimEnd().split('\n').at(-1);
    return `${command.join(' ')}: ${first.trim()}`;
  }
  return null;
}

await main(async () => {
  const chosen = MUTATIONS.filter(({ name }) => name.includes(values.only));
  const folder = await checkout();
  const found = { test: 0, all: 0 };
  const commands = new Map(
    chosen.flatMap(({ test, all = [] }) => [...test, ...all]).map((one) => [one.join(' '), one]),
  );
  try {
    await run(process.execPath, ['scripts/test.mjs', '--only', 'build-quick'], { cwd: folder });
    const broken = await failure(folder, [...commands.values()]);
    if (broken) throw new Error(`the tests fail without a mistake: ${broken}`);
    for (const mutation of chosen) {
      const path = join(folder, mutation.file);
      const source = readFileSync(path, 'utf8');
      writeFileSync(path, mutated(source, mutation));
      const quick = await failure(folder, mutation.test);
      const late = quick ?? (await failure(folder, mutation.all));
      writeFileSync(path, source);
      found.test += quick ? 1 : 0;
      found.all += late ? 1 : 0;
      console.log(
        `${mutation.name}: ${late ? `found by npm ${quick ? 'test' : 'run test:all'}: ${late}` : 'not found'}`,
      );
    }
  } finally {
    if (!values.clone) rmSync(folder, { recursive: true, force: true });
  }
  console.log(`npm test finds ${found.test} of ${chosen.length}, npm run test:all ${found.all}`);
  if (found.test < QUICK_SHARE * chosen.length || found.all < chosen.length) process.exitCode = 1;
});
