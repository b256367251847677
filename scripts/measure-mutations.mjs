// Breaks ten things, one after the other, in a clone of the commit that is checked out, and tells which of them the tests
// find (scripts/lib/mutations.mjs). Fails where `npm test` finds fewer than eight, or `npm run test:all` not all.
// `--only TEXT` takes those whose name has it; `--clone FOLDER` keeps the clone there, and what was built in it for the
// next time. Takes about an hour.
import { spawnSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join, resolve } from 'node:path';
import { parseArgs } from 'node:util';
import { MUTATIONS, mutated } from './lib/mutations.mjs';
import { root } from './lib/paths.mjs';
import { main, output, run, runKeeping } from './lib/run.mjs';

/** As many of ten as `npm test` has to find. */
const QUICK_SHARE = 0.8;

const { values } = parseArgs({ options: { only: { type: 'string', default: '' }, clone: { type: 'string' } } });

async function checkout() {
  const commit = output('git', ['rev-parse', 'HEAD'])?.trim();
  const folder = values.clone ? resolve(values.clone) : mkdtempSync(join(tmpdir(), 'boresight-mutations-'));
  if (!existsSync(join(folder, '.git'))) await run('git', ['clone', '--quiet', root, folder]);
  if (spawnSync('git', ['-C', folder, 'diff', '--quiet', 'HEAD']).status !== 0) {
    throw new Error(`${folder} has changes that are not committed`);
  }
  await run('git', ['-C', folder, 'fetch', '--quiet', root, 'HEAD']);
  await run('git', ['-C', folder, '-c', 'advice.detachedHead=false', 'checkout', '--quiet', commit]);
  return folder;
}

/** Runs steps in the clone; what failed first, or null. */
async function failure(folder, steps) {
  const { ok, text } = await runKeeping(process.execPath, ['scripts/test.mjs', '--only', steps], { cwd: folder });
  if (ok) return null;
  return /^.*(?:✖|panicked at|error\b).*$/m.exec(text)?.[0].trim() ?? text.trimEnd().split('\n').at(-1);
}

await main(async () => {
  const chosen = MUTATIONS.filter(({ name }) => name.includes(values.only));
  const folder = await checkout();
  const found = { test: 0, all: 0 };
  try {
    const broken = await failure(folder, [...new Set(chosen.flatMap(({ steps }) => steps.split(',')))].join(','));
    if (broken) throw new Error(`the tests fail without a mistake: ${broken}`);
    for (const mutation of chosen) {
      const path = join(folder, mutation.file);
      const source = readFileSync(path, 'utf8');
      writeFileSync(path, mutated(source, mutation));
      const quick = await failure(folder, mutation.steps);
      const late = quick ?? (mutation.others ? await failure(folder, mutation.others) : null);
      writeFileSync(path, source);
      found.test += quick ? 1 : 0;
      found.all += late ? 1 : 0;
      const by = quick ? `npm test (${mutation.steps})` : `npm run test:all (${mutation.others})`;
      console.log(`${mutation.name}: ${late ? `found by ${by}: ${late}` : 'not found'}`);
    }
  } finally {
    if (!values.clone) rmSync(folder, { recursive: true, force: true });
  }
  console.log(`npm test finds ${found.test} of ${chosen.length}, npm run test:all ${found.all}`);
  if (found.test < QUICK_SHARE * chosen.length || found.all < chosen.length) process.exitCode = 1;
});
