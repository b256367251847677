import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { root } from '../../scripts/lib/paths.mjs';
import { runBehind } from '../../scripts/lib/run.mjs';
import {
  edited,
  mainScript,
  PARTS,
  processorSeconds,
  settings,
  table,
  verdict,
} from '../../scripts/lib/setup-measures.mjs';

test('parts are chosen by name, and others refused', () => {
  assert.deepEqual(settings([]), { only: PARTS, cold: false, keep: false });
  assert.deepEqual(settings(['--cold', '--only', 'start,edit']), { only: ['start', 'edit'], cold: true, keep: false });
  assert.throws(() => settings(['--only', 'start,tests']), /no part “tests”; there are start, cli, test, edit/);
  assert.throws(() => settings(['--only']), /no part/);
  assert.throws(() => settings(['--hot']), /unknown argument --hot/);
});

test('a target is missed above it, and not where there is none', () => {
  assert.equal(verdict({ target: 90, seconds: 90 }), 'ok');
  assert.equal(verdict({ target: 90, seconds: 90.1 }), 'missed');
  assert.equal(verdict({ seconds: 1e6 }), 'ok');
  assert.equal(verdict({ target: 90, seconds: 1, problem: 'ended with status 1' }), 'failed');
});

test('the table has what was measured beside its target', () => {
  const lines = table([
    { name: 'quick', target: 90, seconds: 12.34, cpuSeconds: 20 },
    { name: 'endless', seconds: 1000, cpuSeconds: 1, problem: 'ended' },
  ]).split('\n');
  assert.deepEqual(
    lines.map((line) => line.split(/ {2,}/)),
    [
      ['step', 'seconds', 'target', 'CPU seconds'],
      ['quick', '12.3', '90', '20.0', 'ok'],
      ['endless', '1000.0', '–', '1.0', 'failed'],
    ],
  );
});

test('the edit is in the body of a function, one line, and another each time', () => {
  const source = readFileSync(join(root, 'crates', 'aoa', 'src', 'estimators', 'capon.rs'), 'utf8');
  const lines = edited(source, 7).split('\n');
  const at = lines.findIndex((line) => line.includes('black_box(7_u64);'));
  assert.match(lines[at - 1], /pub fn .*\{$/);
  assert.equal(lines.toSpliced(at, 1).join('\n'), source);
  assert.notEqual(edited(source, 7), edited(source, 8));
  assert.throws(() => edited('fn private() {\n}', 1), /no public function/);
});

test('the script of a page is found', () => {
  assert.equal(mainScript('<head><script type="module" crossorigin src="./assets/a.js"></script>'), './assets/a.js');
  assert.equal(mainScript('<p>no script</p>'), null);
});

test('time of processors is that of all, idle time left out', () => {
  const times = { user: 1000, nice: 200, sys: 30, idle: 9e9, irq: 4 };
  assert.equal(processorSeconds([{ times }, { times }]), 2.468);
});

test('a command behind gives its lines, and its last ones with its failure', async () => {
  const lines = [];
  const program = (code) => ['-e', `console.log('one'); console.error('error: two'); process.exitCode = ${code}`];
  await runBehind(process.execPath, program(0), (line) => lines.push(line));
  assert.deepEqual(lines.toSorted(), ['error: two', 'one']);
  const error = await runBehind(process.execPath, program(3), () => {}).catch((thrown) => thrown);
  assert.match(error.message, /ended with status 3:\n.*error: two/s);
});

test('what runs beside a script that failed ends with it, and is not blamed', () => {
  const script = `
    import { main, run } from './scripts/lib/run.mjs';
    await main(async () => {
      void run(process.execPath, ['-e', 'setTimeout(() => {}, 600_000)']);
      throw new Error('broken');
    });`;
  const ended = spawnSync(process.execPath, ['--input-type=module', '-e', script], {
    cwd: root,
    encoding: 'utf8',
    timeout: 60_000,
  });
  assert.equal(ended.status, 1, 'it ended by itself');
  assert.equal(ended.stderr.trim(), 'broken');
});
