// Regions of interest, against a discrete Fourier transform and sums written out.
import assert from 'node:assert/strict';
import { before, test } from 'node:test';
import { init, simulateCube, strongestRegion, waveformPreset, waveformPresets } from 'boresight';
import { throwsTyped } from './lib/assert.mjs';

before(() => init());

const cubeOf = (targets, more) =>
  simulateCube({
    waveform: waveformPreset('3dcnn-simulated'),
    array: 'ula8',
    snrDb: 20,
    seed: 5,
    targets,
    ...more,
  });

/** The spectrum of one range bin of one row of 256 samples. */
function bin(data, row, k) {
  const [samples, out] = [256, [0, 0]];
  for (let n = 0; n < samples; n++) {
    const turn = (-2 * Math.PI * k * n) / samples;
    const [re, im] = [data[2 * (row * samples + n)], data[2 * (row * samples + n) + 1]];
    out[0] += (re * Math.cos(turn) - im * Math.sin(turn)) / samples;
    out[1] += (re * Math.sin(turn) + im * Math.cos(turn)) / samples;
  }
  return out;
}

const near = (given, expected, by) => assert.ok(Math.abs(given - expected) <= by, `${given} for ${expected}`);

test('a region is the spectrum of the bins around the strongest, and its covariance their mean', () => {
  const cube = cubeOf([
    { rangeM: 80, azimuthDeg: -7 },
    { rangeM: 74.3, azimuthDeg: 3, powerDb: -6 },
  ]);
  const { rangeBin, region, covariance, snapshots, channels, features } = strongestRegion(cube);
  assert.equal(rangeBin, 80);
  assert.deepEqual(
    [region.shape, covariance.shape, snapshots.shape],
    [
      [65, 8, 4],
      [8, 8],
      [8, 4],
    ],
  );
  for (const [b, element, chirp] of [
    [0, 0, 0],
    [32, 3, 1],
    [26, 7, 3],
    [64, 5, 2],
  ]) {
    const expected = bin(cube.data, chirp * 8 + element, rangeBin - 32 + b);
    const at = (b * 8 + element) * 4 + chirp;
    expected.forEach((value, part) => near(region.data[2 * at + part], value, 1e-5));
    const [size, re, im] = channels.subarray(3 * at, 3 * at + 3);
    near(size, Math.hypot(...expected), 1e-5);
    assert.deepEqual([re, im], [...region.data.subarray(2 * at, 2 * at + 2)]);
    if (b === 32) assert.equal(snapshots.data[2 * (element * 4 + chirp)], re);
  }
  const sum = (i, k) => {
    const all = [0, 0];
    for (let b = 0; b < 65; b++)
      for (let chirp = 0; chirp < 4; chirp++) {
        const [x, y] = [i, k].map((element) => 2 * ((b * 8 + element) * 4 + chirp));
        const [p, q, r, s] = [region.data[x], region.data[x + 1], region.data[y], region.data[y + 1]];
        all[0] += (p * r + q * s) / 4;
        all[1] += (q * r - p * s) / 4;
      }
    return all;
  };
  let largest = 0;
  for (let i = 0; i < 8; i++) largest = Math.max(largest, sum(i, i)[0]);
  let next = 0;
  for (let i = 0; i < 8; i++)
    for (let k = 0; k < 8; k++)
      sum(i, k).forEach((value, part) => {
        near(covariance.data[2 * (i * 8 + k) + part], value, 1e-9);
        if (k > i) near(features[next++], value / largest, 1e-6);
      });
  assert.equal(next, features.length);
});

test('a region has as many bins and chirps as are asked for, and wraps', () => {
  const cube = cubeOf([{ rangeM: 2 }]);
  const { rangeBin, region } = strongestRegion(cube, { bins: 9, chirps: 1 });
  assert.equal(rangeBin, 2);
  assert.deepEqual(region.shape, [9, 8, 1]);
  bin(cube.data, 0, 254).forEach((value, part) => near(region.data[part], value, 1e-5));
});

test('what is no cube of one frame, or has too few bins, is refused', () => {
  const cube = cubeOf([{ rangeM: 80 }]);
  throwsTyped(() => strongestRegion(cube, { bins: 257 }), 'out-of-range', 'region length');
  throwsTyped(() => strongestRegion(cube, { chirps: 5 }), 'out-of-range', 'region chirps');
  throwsTyped(() => strongestRegion(cube, { bin: 9 }), 'unknown-option', 'bin');
  throwsTyped(() => strongestRegion(cubeOf([{ rangeM: 80 }], { frames: 2 })), 'shape', 'cube');
});

test('waveforms are known by name', () => {
  for (const name of waveformPresets()) assert.ok(waveformPreset(name).samples > 0, name);
  assert.equal(waveformPreset('3dcnn-simulated').samples, 256);
  throwsTyped(() => waveformPreset('3dcnn'), 'unknown-name', 'waveform');
});
