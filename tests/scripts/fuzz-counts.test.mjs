import assert from 'node:assert/strict';
import { test } from 'node:test';
import { fuzzCounts, fuzzTable } from '../../scripts/lib/checks/fuzz-counts.mjs';

test('runs are those of the closing lines, or of the last progress before a crash', () => {
  const ended = '#2\tINITED\n#512\tDONE\nstat::number_of_executed_units: 512\nstat::average_exec_per_sec:     256\n';
  assert.deepEqual(fuzzCounts(ended, 2), { runs: 512, rate: 256 });
  assert.deepEqual(fuzzCounts('#2\tINITED cov: 3\n#64\tNEW    cov: 9\n==1== ERROR\n', 4), { runs: 64, rate: 16 });
  assert.deepEqual(fuzzCounts('error: could not compile', 4), { runs: 0, rate: 0 });
});

test('the table has a line for each target', () => {
  const lines = fuzzTable([{ name: 'uart', runs: 512, rate: 256, corpus: 7, crashes: 0 }]).split('\n');
  assert.deepEqual(lines[0].split(/\s+/), ['target', 'runs', 'runs/s', 'corpus', 'crashes']);
  assert.deepEqual(lines[1].split(/\s+/), ['uart', '512', '256', '7', '0']);
});
