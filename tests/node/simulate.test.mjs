import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { init, simulateCube, simulateSnapshots } from 'boresight';
import { createPool } from 'boresight/worker';
import { throwsTyped } from './lib/assert.mjs';

const options = { array: 'lrr48', targets: { count: [2, 10] }, snrDb: 20, snapshots: 3, scenes: 21, seed: 7 };
const waveform = {
  startFrequencyHz: 77e9,
  slopeHzPerS: 60e12,
  sampleRateHz: 5e6,
  samples: 64,
  adcStartS: 5e-6,
  chirpIntervalS: 80e-6,
  transmitters: 2,
  loops: 4,
  frameIntervalS: 40e-3,
};
const cubeOptions = { waveform, array: 'awr1642', targets: [{ rangeM: 3 }], snrDb: 10, seed: 1 };

let pool;
before(async () => {
  await init();
  pool = createPool({ workers: 2 });
});
after(() => pool.terminate());

test('snapshots have their shape, truth and power', () => {
  const { data, shape, truth } = simulateSnapshots(options);
  assert.deepEqual(shape, [21, 48, 3]);
  assert.equal(data.length, 2 * 21 * 48 * 3);
  assert.equal(truth.length, 21);
  assert.ok(truth.every((scene) => scene.length >= 2 && scene.length <= 10));
  assert.ok(truth.flat().every((t) => Math.abs(t.azimuthDeg) <= 60 && t.powerDb >= -13 && t.powerDb <= 0));
  const noise = simulateSnapshots({ ...options, targets: [], snrDb: 10, scenes: 100 }).data;
  const power = noise.reduce((sum, x) => sum + x * x, 0) / (noise.length / 2);
  // 14,400 complex normal samples: their mean power is within 5 / sqrt(14,400) of 0.1.
  assert.ok(Math.abs(power / 0.1 - 1) < 0.042, `${power}`);
});

test('a seed gives the same, whichever way a sweep is split', async () => {
  const whole = simulateSnapshots(options);
  assert.deepEqual(simulateSnapshots({ ...options, seed: 7n }), whole);
  assert.notDeepEqual(simulateSnapshots({ ...options, seed: 8 }).data, whole.data);
  const part = simulateSnapshots({ ...options, firstScene: 5, scenes: 2 });
  const size = whole.data.length / 21;
  assert.deepEqual(part.data, whole.data.slice(5 * size, 7 * size));
  const progress = [];
  assert.deepEqual(await pool.simulateSnapshots(options, { onProgress: (...step) => progress.push(step) }), whole);
  assert.deepEqual(progress.at(-1), [21, 21]);
  assert.deepEqual(await pool.simulateCube(cubeOptions), simulateCube(cubeOptions));
});

test('given targets, their phases and imperfections are obeyed', () => {
  const target = { azimuthDeg: 30, powerDb: -6, phaseDeg: 90 };
  const given = { array: 'ula4', targets: [target], snrDb: 300, seed: 1 };
  const { data, truth } = simulateSnapshots(given);
  const amplitude = 10 ** (-6 / 20);
  // Element 0 has the target's phase; at 30 deg each further element leads by a quarter turn.
  const expected = [
    [0, 1],
    [-1, 0],
    [0, -1],
    [1, 0],
  ].flat();
  data.forEach((x, i) => assert.ok(Math.abs(x - amplitude * expected[i]) < 1e-9, `${i}: ${x}`));
  assert.ok(Math.abs(truth[0][0].azimuthDeg - 30) < 1e-9);
  const spoilt = simulateSnapshots({
    ...given,
    imperfections: { gainDb: 1, phaseDeg: 10, position: 0.1, couplingDb: -20 },
  });
  assert.notDeepEqual(spoilt.data, data);
});

test('what cannot be simulated is refused by name', () => {
  const bad = (change, code, what) => throwsTyped(() => simulateSnapshots({ ...options, ...change }), code, what);
  bad({ seed: undefined }, 'missing', 'seed');
  bad({ seed: -1 }, 'out-of-range', 'seed');
  bad({ seed: 1.5 }, 'out-of-range', 'seed');
  bad({ seed: 2n ** 64n }, 'wrong-type', 'seed');
  bad({ snrDb: Number.NaN }, 'out-of-range', 'snrDb');
  bad({ snapshots: 0 }, 'out-of-range', 'snapshots');
  bad({ scenes: 1e9 }, 'too-large');
  bad({ targets: { count: [5, 2] } }, 'out-of-range');
  bad({ targets: { counts: [1, 2] } }, 'unknown-option', 'targets.counts');
  bad({ targets: [{ azimuthDeg: 'left' }] }, 'wrong-type', 'targets[0].azimuthDeg');
  bad({ fluctuation: 'swerling' }, 'unknown-name', 'fluctuation');
  bad({ imperfections: { gainDb: -1 } }, 'out-of-range');
  bad({ imperfections: { couplingDb: 3 } }, 'out-of-range');
  const badCube = (change, code, what) => throwsTyped(() => simulateCube({ ...cubeOptions, ...change }), code, what);
  badCube({ targets: [{ rangeM: -1 }] }, 'out-of-range');
  badCube({ targets: [{ rangeM: Number.POSITIVE_INFINITY }] }, 'out-of-range', 'targets[0].rangeM');
  badCube({ array: 'ula8' }, 'shape');
  badCube({ frames: 1e8 }, 'too-large');
  badCube({ waveform: { ...waveform, samples: 1 } }, 'out-of-range', 'samples');
  assert.equal(simulateCube({ ...cubeOptions, nearField: true }).shape.length, 5);
});
