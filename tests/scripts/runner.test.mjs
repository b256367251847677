import assert from 'node:assert/strict';
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join, relative } from 'node:path';
import { after, test } from 'node:test';
import { findBrowser } from '../../scripts/lib/browser.mjs';
import { digest, filesUnder, upToDate, whenChanged } from '../../scripts/lib/build/stamp.mjs';
import { root } from '../../scripts/lib/paths.mjs';
import { runKeeping } from '../../scripts/lib/run.mjs';
import { cargoCounts, nodeCounts, passedOnRetry, summary } from '../../scripts/lib/summary.mjs';

const folder = mkdtempSync(join(root, 'tests', '.stamp-'));
const inside = (name) => relative(root, join(folder, name));
after(() => rmSync(folder, { recursive: true }));

test('results of cargo are added over all its binaries', () => {
  const text = [
    'test result: ok. 12 passed; 0 failed; 0 ignored; 0 measured; 0 filtered out; finished in 0.1s',
    'note: test result: ok. 99 passed; 9 failed; 9 ignored',
    'test result: \u001b[31mFAILED\u001b[0m. 3 passed; 2 failed; 1 ignored; 0 measured; 0 filtered out',
  ].join('\n');
  assert.deepEqual(cargoCounts(text), { passed: 15, failed: 2, skipped: 1 });
  assert.deepEqual(cargoCounts('error: could not compile'), { passed: 0, failed: 0, skipped: 0 });
});

test('closing lines of node are read from both reporters', () => {
  const spec = 'ℹ tests 9\nℹ pass 5\nℹ fail 1\nℹ cancelled 1\nℹ skipped 1\nℹ todo 1\n';
  const expected = { passed: 5, failed: 2, skipped: 2 };
  assert.deepEqual(nodeCounts(spec), expected);
  assert.deepEqual(nodeCounts(spec.replaceAll('ℹ', '#')), expected);
  assert.deepEqual(nodeCounts(`# pass 100\n${spec}`), expected);
});

test('the summary closes with the totals alone on a line', () => {
  const step = { passed: 2, failed: 1, skipped: 0, seconds: 1 };
  const lines = summary([
    { name: 'a', ...step },
    { name: 'b', ...step, skipped: 3 },
  ]).split('\n');
  assert.equal(lines.at(-1), '4 passed, 2 failed, 3 skipped');
});

test('a browser that is named but missing is not replaced by another', () => {
  assert.equal(findBrowser({ PATH: process.env.PATH, CHROMIUM: '/no/such/chromium' }), null);
  assert.equal(findBrowser({ PATH: '', CHROMIUM: process.execPath }), process.execPath);
});

test('a command that runs too long is killed with what it started, and its pipes are not waited for', {
  skip: process.platform === 'win32' && 'there is no sh',
}, async () => {
  // The grandchild holds the pipes of its parent for longer than any test may take.
  const { ok, text } = await runKeeping('sh', ['-c', 'sleep 600 & echo $!; wait'], { timeout: 300 });
  assert.equal(ok, false);
  const [pid, note] = text.trim().split('\n');
  assert.equal(note, 'sh was killed after 0.3 s');
  const gone = () => {
    try {
      // A zombie that nobody has reaped yet is no longer running.
      return / Z /.test(readFileSync(`/proc/${pid}/stat`, 'utf8'));
    } catch {
      return true;
    }
  };
  for (let tries = 0; !gone() && tries < 500; tries++) await new Promise((next) => setTimeout(next, 10));
  assert.ok(gone(), `process ${pid} still runs`);
  assert.deepEqual(await runKeeping('sh', ['-c', 'echo done'], { timeout: 60_000 }), { ok: true, text: 'done\n' });
});

test('digests follow names and contents and leave build outputs out', () => {
  writeFileSync(join(folder, 'a'), 'one');
  mkdirSync(join(folder, 'target'));
  writeFileSync(join(folder, 'target', 'b'), 'built');
  assert.deepEqual(filesUnder(inside('')), [`${inside('')}/a`]);
  const first = digest([inside('')]);
  writeFileSync(join(folder, 'target', 'b'), 'built again');
  assert.equal(digest([inside('')]), first);
  writeFileSync(join(folder, 'a'), 'two');
  assert.notEqual(digest([inside('')]), first);
  assert.notEqual(digest([inside('')], ['extra']), digest([inside('')]));
});

test('work is done when inputs change or outputs are gone, and else not', async () => {
  writeFileSync(join(folder, 'input'), '1');
  let runs = 0;
  const paths = { inputs: [inside('input')], outputs: [inside('output')] };
  const go = () =>
    whenChanged('runner-test', paths, () => {
      runs += 1;
      writeFileSync(join(folder, 'output'), 'x');
    });
  rmSync(join(folder, 'output'), { force: true });
  await go();
  assert.equal(await go(), false);
  assert.equal(runs, 1);
  writeFileSync(join(folder, 'input'), `changed at ${process.hrtime.bigint()}`);
  assert.equal(await go(), true);
  rmSync(join(folder, 'output'));
  assert.equal(await go(), true);
  assert.equal(runs, 3);
  assert.equal(upToDate('runner-test', { ...paths, extra: ['quick'] }), false);
  assert.equal(upToDate('runner-test', { ...paths, extra: ['quick'], better: [[]] }), true, 'a better one will do');
  await whenChanged('runner-test', { ...paths, extra: ['quick'] }, () => {});
  assert.equal(upToDate('runner-test', paths), false, 'a quick one will not');
  await assert.rejects(
    whenChanged('runner-test-empty', { ...paths, outputs: [inside('never')] }, () => {}),
    /did not make .*never/,
  );
});

test('page tests that pass only on the second try are named', () => {
  const text = '✔ one (3 ms)\npassed on retry: space: frames play\n  passed on retry: quoted\nℹ pass 2\n';
  assert.deepEqual(passedOnRetry(text), ['space: frames play']);
});
