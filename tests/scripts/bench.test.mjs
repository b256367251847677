import assert from 'node:assert/strict';
import { test } from 'node:test';
import { recorded, regressions } from '../../bench/baseline.mjs';

const row = (name, median, spread, more = {}) => ({
  name,
  keep: true,
  ratio: { median, low: median / spread, high: median * spread },
  ...more,
});

test('only ratios within one process are kept', () => {
  const rows = [
    row('a', 3, 1.1),
    row('b', 2, 1.1, { keep: false }),
    row('c', 2, 1.1, { error: 'differs' }),
    { name: 'd', value: 1 },
  ];
  assert.deepEqual(Object.keys(recorded(rows)), ['a']);
});

test('a ratio may fall by three times the noise of either run, and no further', () => {
  const baseline = recorded([row('a', 4, 1.2)]);
  // 1.2 cubed is 1.73.
  assert.deepEqual(regressions([row('a', 4 / 1.7, 1.05)], baseline), []);
  assert.equal(regressions([row('a', 4 / 1.76, 1.05)], baseline).length, 1);
  assert.deepEqual(regressions([row('a', 4 / 1.76, 1.3)], baseline), [], 'a noisy run');
  assert.deepEqual(regressions([row('a', 40, 1.01)], baseline), [], 'faster');
});

test('quiet runs are taken to have some noise', () => {
  const baseline = recorded([row('a', 4, 1.001)]);
  assert.deepEqual(regressions([row('a', 3, 1.001)], baseline), []);
  assert.equal(regressions([row('a', 2.9, 1.001)], baseline).length, 1);
});

test('what is missing or in error is said', () => {
  const baseline = recorded([row('a', 4, 1.1)]);
  assert.deepEqual(regressions([], baseline), ['a: not measured']);
  assert.deepEqual(regressions([{ name: 'a', error: 'differs' }], baseline), ['a: differs']);
});
