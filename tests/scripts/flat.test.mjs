// Whether memory is flat is told from the samples of a run.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { verdicts } from '../../scripts/lib/build/flat.mjs';

const samples = (of) => Array.from({ length: 90 }, (_, index) => of(index));

test('what warms up and then stays is flat, and what grows on is not', () => {
  const series = {
    flat: samples((n) => 100 + (n % 7)),
    warming: samples((n) => Math.min(100, 10 * n) + (n % 3)),
    falling: samples((n) => 200 - n),
    leaking: samples((n) => 100 + n),
    'a step': samples((n) => (n < 60 ? 100 : 130)),
  };
  const found = Object.fromEntries(verdicts(series).map(({ name, flat }) => [name, flat]));
  assert.deepEqual(found, { flat: true, warming: true, falling: true, leaking: false, 'a step': false });
});

test('small numbers may change by what is their noise', () => {
  const series = { workers: samples((n) => (n < 60 ? 1 : 2)) };
  assert.equal(verdicts(series)[0].flat, false);
  assert.equal(verdicts(series, { least: { workers: 1 } })[0].flat, true);
});

test('too few samples say nothing', () => {
  assert.equal(verdicts({ few: [1, 1] })[0].flat, false);
});

test('what is nowhere has not grown', () => {
  const { share, flat } = verdicts({ handles: samples(() => 0) })[0];
  assert.deepEqual([share, flat], [0, true]);
});
