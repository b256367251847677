// What one call may take: known before it starts, refused above a limit that can be raised.
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { countSources, Estimator, estimate, init, setLimits, simulateSnapshots, version } from 'boresight';
import { createPool } from 'boresight/worker';
import { operationsOf, requests } from '../../bench/extremes.mjs';
import glue from '../../dist/wasm/boresight.js';
import { batchOf, planeWaves, rejectsTyped, throwsTyped } from './lib/assert.mjs';

const options = { method: 'iaa', array: 'ula10' };
const input = { snapshots: planeWaves(10, 1, [10]) };
const thrown = (call) => {
  try {
    call();
  } catch (error) {
    return error;
  }
  return undefined;
};

describe('limits of a call', () => {
  before(() => init());
  after(() => setLimits());

  test('extreme requests say what they would take before they start, and the largest are refused', () => {
    let refused = 0;
    for (const [name, call] of requests()) {
      const { operations, error } = operationsOf(call);
      // What does not suit is said first.
      if (['unsuitable-array', 'cfar-window'].includes(error?.code)) continue;
      assert.equal(error?.code, 'too-large', `${name}: ${error?.message}`);
      assert.match(error.details.expected, /^at most 1\.000e0, limits\.operations/);
      if (operations <= 1e10) continue;
      throwsTyped(call, 'too-large');
      refused += 1;
    }
    assert.ok(refused >= 10, `${refused} refused`);
  });

  test('limits can be raised and go back', () => {
    setLimits({ operations: 1e4 });
    throwsTyped(() => estimate(input, options), 'too-large', 'the estimate');
    throwsTyped(
      () => new Estimator(options).estimateBatch({ snapshots: batchOf([input.snapshots, input.snapshots]) }),
      'too-large',
      'the estimates',
    );
    const wide = { data: new Float64Array(4 * 40).fill(1), shape: [40, 2] };
    throwsTyped(() => countSources({ snapshots: wide }), 'too-large', 'the count of sources');
    setLimits({ operations: 1e7 });
    assert.equal(countSources({ snapshots: wide }).eigenvalues.length, 40);
    assert.equal(estimate(input, options).method, 'iaa');
    const many = { array: 'ula10', targets: [{ azimuthDeg: 1 }], scenes: 10, snapshots: 1000, seed: 1 };
    setLimits({ bytes: 1e5 });
    throwsTyped(() => simulateSnapshots(many), 'too-large', 'the snapshots');
    assert.match(thrown(() => simulateSnapshots(many)).details.expected, /limits\.bytes/);
    setLimits();
    assert.deepEqual(simulateSnapshots(many).shape, [10, 10, 1000]);
  });

  test('what is no limit is refused and changes nothing', () => {
    setLimits({ operations: 1e4 });
    throwsTyped(() => setLimits({ operations: 0 }), 'out-of-range', 'operations');
    throwsTyped(() => setLimits({ bytes: Number.NaN }), 'out-of-range', 'bytes');
    throwsTyped(() => setLimits({ seconds: 1 }), 'unknown-option', 'seconds');
    throwsTyped(() => setLimits(5), 'wrong-type');
    const { proxy, revoke } = Proxy.revocable({}, {});
    revoke();
    const throwing = {
      get operations() {
        throw new Error('no');
      },
    };
    for (const lie of [proxy, throwing, { operations: 1n }, { operations: {} }, []]) throwsTyped(() => setLimits(lie));
    throwsTyped(() => estimate(input, options), 'too-large');
    setLimits();
  });

  test('a fresh instance after a trap has them too', async () => {
    setLimits({ operations: 1e4 });
    const { memory } = await glue();
    // Nothing a caller may pass traps, so the memory under the module has to be spoilt.
    new Uint8Array(memory.buffer).fill(0xff);
    throwsTyped(() => estimate(input, options), 'trap');
    await init();
    throwsTyped(() => estimate(input, options), 'too-large');
    setLimits();
    assert.equal(estimate(input, options).method, 'iaa');
  });

  test('workers have limits of their own', async () => {
    setLimits({ operations: 1 });
    const [free, tight] = [createPool({ workers: 1 }), createPool({ workers: 1, limits: { operations: 1e3 } })];
    try {
      assert.equal((await free.estimate(input, options)).method, 'iaa');
      await rejectsTyped(tight.estimate(input, options), 'too-large');
    } finally {
      for (const pool of [free, tight]) pool.terminate();
      setLimits();
    }
  });

  test('a call that needs no operations knows no limit', () => {
    setLimits({ operations: 1 });
    assert.match(version(), /^\d/);
    setLimits();
  });
});
