import assert from 'node:assert/strict';
import { test } from 'node:test';
import { mutated } from '../../scripts/lib/mutations.mjs';

test('a place that is missing or not the only one is an error', () => {
  const mutation = { name: 'sign', file: 'a.rs', from: '+ 1', to: '- 1' };
  assert.equal(mutated('a + 1', mutation), 'a - 1');
  assert.throws(() => mutated('a', mutation), /sign: a\.rs has “\+ 1” 0 times/);
  assert.throws(() => mutated('a + 1 + 1', mutation), /2 times/);
});
