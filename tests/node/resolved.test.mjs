// What `resolved` states, and sparse arrays that find more sources than they have elements.
import assert from 'node:assert/strict';
import { before, test } from 'node:test';
import { estimate, init, simulateSnapshots } from 'boresight';

before(() => init());

/** The snapshots of one scene. */
const scene = (options) => {
  const { data, shape } = simulateSnapshots({ snapshots: 1, ...options });
  return { data, shape: shape.slice(1) };
};
const coded = ({ warnings }) => warnings.map(({ code }) => code);

test('noise alone and a phantom beside one target are not resolved', () => {
  const array = 'ula16';
  const snapshots = (targets, seed) => scene({ array, targets, snrDb: 20, seed });
  const noise = snapshots([], 3);
  for (const method of ['bartlett', 'capon', 'iaa']) {
    const found = estimate({ snapshots: noise }, { array, method });
    assert.equal(found.resolved, false, method);
    assert.ok(coded(found).includes('insignificant'), method);
  }
  const one = snapshots([{ azimuthDeg: 10 }], 4);
  assert.equal(estimate({ snapshots: one }, { array, method: 'bartlett' }).resolved, true);
  const two = estimate({ snapshots: one }, { array, method: 'maximum-likelihood', sources: 2 });
  assert.deepEqual([two.resolved, coded(two)], [false, ['insignificant']]);
});

test('five elements find seven sources on their co-array', () => {
  const positions = [0, 1, 4, 7, 9].map((y) => [0, y, 0]);
  const azimuths = [-58, -33, -14, 3, 20, 41, 64];
  const targets = azimuths.map((azimuthDeg) => ({ azimuthDeg }));
  const array = { positions };
  const snapshots = scene({
    array,
    targets,
    snrDb: 20,
    snapshots: 2000,
    fluctuation: 'complex-normal',
    seed: 5,
  });
  const found = estimate({ snapshots }, { array, method: 'coarray-music', sources: 7 });
  assert.equal(found.resolved, true, JSON.stringify(found.warnings));
  const angles = found.sources.map(({ azimuthDeg }) => azimuthDeg).sort((a, b) => a - b);
  azimuths.forEach((azimuth, k) => assert.ok(Math.abs(angles[k] - azimuth) < 2, `${angles}`));
});
