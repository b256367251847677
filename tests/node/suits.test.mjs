// Rules that pages ask the package for: what suits a method, an array's resolution.
import assert from 'node:assert/strict';
import { before, test } from 'node:test';
import { array, BoresightError, estimate, init, methods, unsuited } from 'boresight';
import { planeWaves, throwsTyped } from './lib/assert.mjs';

before(() => init());

test('what is said not to suit is what an estimate refuses', () => {
  const places = (...list) => ({ positions: list.map((y) => [0, y, 0]) });
  const reasons = new Set();
  for (const one of ['ula6', places(0, 2, 5), places(0, 1, Math.SQRT2, 7), 'awr1843']) {
    const { positions } = array(one);
    for (const { name, network } of methods()) {
      if (network) continue;
      for (const snapshots of [1, 8]) {
        const options = { method: name, array: one, sources: 1 };
        const said = unsuited(options, snapshots);
        reasons.add(said);
        const { data } = planeWaves(positions.length, snapshots, [3]);
        const run = () => estimate({ snapshots: { data, shape: [positions.length, snapshots] } }, options);
        if (said === null) run();
        else
          assert.throws(
            run,
            (error) => error instanceof BoresightError && /^(unsuitable-array|snapshot-count)$/.test(error.code),
            `${name}: ${said}`,
          );
      }
    }
  }
  for (const reason of [null, 'uniform-array', 'grid', 'elevation', 'few-snapshots', 'many-snapshots'])
    assert.ok(reasons.has(reason), reason);
});

test('places 0, 2 and 5 stand on a grid of one', () => {
  const positions = [0, 2, 5].map((y) => [0, y, 0]);
  const wanting = methods().filter(({ lattice, network }) => lattice && !network);
  assert.ok(wanting.length > 0);
  for (const { name, uniformArray, minSnapshots } of wanting) {
    // No two of them are one step apart, so the difference co-array begins with a gap.
    const reason = uniformArray ? 'uniform-array' : name === 'coarray-music' ? 'no-neighbours' : null;
    assert.equal(unsuited({ method: name, array: { positions } }, minSnapshots), reason, name);
  }
  throwsTyped(() => unsuited({ method: 'capon' }, 1), 'missing', 'array');
  throwsTyped(() => unsuited({ method: 'capon', array: 'ula4' }, -1), 'out-of-range', 'snapshots');
});

test('the resolution of an array is the first null of its beam', () => {
  const degrees = (sine) => (Math.asin(sine) * 180) / Math.PI;
  assert.ok(Math.abs(array('ula8').resolutionDeg - degrees(2 / 8)) < 1e-9);
  assert.ok(Math.abs(array('awr1642').resolutionDeg - degrees(2 / 8)) < 1e-9);
  assert.equal(array('ula2').resolutionDeg, 90);
});
