// DeepEgo's networks in the calibration: in the functions, on the pool, one frame at a time.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, describe, test } from 'node:test';
import {
  Calibration,
  calibrateDrive,
  driveFrame,
  frameVerdicts,
  init,
  initDrives,
  jointCalibration,
  readNpy,
  scanMotion,
  simulateDrive,
} from 'boresight';
import { createPool } from 'boresight/worker';
import { rejectsTyped, throwsTyped } from './lib/assert.mjs';

const weights = (name) => readFileSync(new URL(`../../models/motion/${name}.bin`, import.meta.url));
const [single, smoothing] = ['deepego', 'deepego-plus'].map(weights);

describe('motions by networks', () => {
  let drive;
  let pool;
  before(async () => {
    await Promise.all([init(), initDrives()]);
    drive = simulateDrive({ durationS: 20, seed: 3, profile: 'radarscenes' });
    pool = createPool({ workers: 1 });
  });
  after(() => pool.terminate());

  const options = (motion, method = 'least-squares') => ({
    sensor: 1,
    method,
    motion,
    network: smoothing,
    weights: true,
  });

  test('every method finds the angle with them, on the pool as here', async () => {
    const nominal = drive.sensors.find(({ id }) => id === 1).yawDeg;
    for (const [method, motion] of [
      ['weighted-mean', 'deepego'],
      ['least-squares', 'deepego-plus'],
      ['recursive', 'deepego'],
    ]) {
      const asked = options(motion, method);
      const here = calibrateDrive(drive, asked);
      // What the drive says of the mounting is some degrees off at most.
      assert.ok(Math.abs(here.result.angleDeg - nominal) < 4, `${method}, ${motion}: ${here.result.angleDeg}`);
      assert.ok(here.result.frames.used > 100, JSON.stringify(here.result.frames));
      assert.ok(here.frames.weights.values.every((weight) => weight >= 0 && weight <= 1));
      assert.deepEqual(await pool.calibrateDrive(drive, asked), here);
      assert.equal(smoothing.length > 0, true, 'the bytes stay with the caller');
    }
    const joint = jointCalibration(drive, { motion: 'deepego', network: smoothing });
    assert.equal(joint.length, drive.sensors.length);
    assert.notEqual(joint[0].result.angleDeg, jointCalibration(drive)[0].result.angleDeg);
  });

  test('range and cross-section reach the network', () => {
    const asked = options('deepego');
    const whole = calibrateDrive(drive, asked);
    for (const column of ['rangeM', 'rcsDbsm']) {
      const without = { ...drive, detections: { ...drive.detections, [column]: null } };
      const found = calibrateDrive(without, asked);
      assert.notDeepEqual(found.frames.weights.values, whole.frames.weights.values, column);
      assert.ok(Math.abs(found.result.angleDeg - whole.result.angleDeg) < 0.3, column);
    }
  });

  test('motions of the 64 golden frames are those of PyTorch to 1e-4', () => {
    const golden = (name) => readNpy(readFileSync(new URL(`../golden/motion/deepego/${name}.npy`, import.meta.url)));
    const [points, mask, motion, weight] = ['points', 'mask', 'motion', 'weights'].map(golden);
    const network = readFileSync(new URL('../golden/motion/deepego/weights.bin', import.meta.url));
    const [frames, most] = points.shape;
    assert.equal(frames, 64);
    let compared = 0;
    for (let f = 0; f < frames; f++) {
      const count = Array.from(mask.data.subarray(f * most, (f + 1) * most)).filter(Boolean).length;
      const column = (place, unit = 1) =>
        Float64Array.from({ length: count }, (_, i) => points.data[4 * (f * most + i) + place] * unit);
      const calibration = new Calibration({ method: 'weighted-mean', motion: 'deepego', xM: 3.6, network });
      const { motion: found } = calibration.addFrame({
        timeS: 0,
        azimuthDeg: column(0, 180 / Math.PI),
        rangeRateMps: column(1),
        rangeM: column(2),
        rcsDbsm: column(3),
        yawRateDegps: 0,
      });
      calibration.free();
      const expected = motion.data.subarray(7 * f, 7 * f + 5);
      const inliers = Array.from(weight.data.subarray(f * most, (f + 1) * most)).filter((w) => w >= 0.5).length;
      // Frames with fewer inliers, or with a velocity that is not known to 1 m/s, have no motion.
      assert.equal(found !== undefined, inliers >= 5 && Math.sqrt(expected[2] + expected[4]) < 1, `frame ${f}`);
      if (!found) continue;
      compared += 1;
      const [[xx, xy], [, yy]] = found.covariance;
      [...found.velocityMps, xx, xy, yy].forEach((value, i) => {
        const off = Math.abs(value - expected[i]) / Math.max(1, Math.abs(expected[i]));
        assert.ok(off < 1e-4, `frame ${f}, number ${i}: ${value}, expected ${expected[i]}`);
      });
    }
    assert.ok(compared > 32, `${compared} of 64 compared`);
  });

  test('a frame at a time is as the drive, and a snapshot goes on with its network', () => {
    const plain = { method: 'recursive', motion: 'deepego', xM: 3.6, nominalDeg: -80 };
    const whole = new Calibration({ ...plain, network: single });
    const cut = new Calibration({ ...plain, network: single });
    const [frames, motion] = [[], scanMotion(drive)];
    for (let scan = 0; scan < drive.scans.timeS.length && frames.length < 80; scan++)
      if (drive.scans.sensor[scan] === 1) frames.push(driveFrame(drive, scan, motion));
    for (const frame of frames) whole.addFrame(frame);
    for (const frame of frames.slice(0, 40)) cut.addFrame(frame);
    const kept = cut.snapshot();
    throwsTyped(() => Calibration.restore(kept), 'needs-weights', 'weights');
    const restored = Calibration.restore(kept, single);
    for (const frame of frames.slice(40)) restored.addFrame(frame);
    assert.deepEqual(restored.estimate(), whole.estimate());
    for (const one of [whole, cut, restored]) one.free();
  });

  test('smoothed motions stand at the frames that they are of, and frames without one at the end', () => {
    const [alone, smoothed] = ['deepego', 'deepego-plus'].map(
      (motion) => calibrateDrive(drive, options(motion)).frames,
    );
    const sparse = frameVerdicts.indexOf('sparse');
    const last = smoothed.verdict.length - 4;
    assert.ok(smoothed.verdict.subarray(last).every((verdict) => verdict === sparse));
    assert.ok(smoothed.vxMps.subarray(last).every(Number.isNaN));
    assert.ok(!Number.isNaN(smoothed.vxMps[last - 1]));
    const off = (by) => {
      const squares = Array.from(alone.vyMps.subarray(0, last - 4), (vy, i) => (vy - smoothed.vyMps[i + by]) ** 2);
      const known = squares.filter(Number.isFinite);
      return Math.sqrt(known.reduce((sum, square) => sum + square, 0) / known.length);
    };
    assert.ok(off(0) < 0.7 * off(4), `${off(0)} m/s apart, ${off(4)} four frames later`);

    const calibration = new Calibration({ ...options('deepego-plus'), weights: undefined, sensor: undefined, xM: 3.6 });
    const [times, motion] = [[], scanMotion(drive)];
    for (let scan = 0; times.length < 10; scan++) {
      if (drive.scans.sensor[scan] !== 1) continue;
      times.push(drive.scans.timeS[scan]);
      const outcome = calibration.addFrame(driveFrame(drive, scan, motion));
      const told = times.length > 4;
      assert.equal(outcome.timeS, times.at(told ? -5 : -1));
      if (!told) assert.equal(outcome.verdict, 'sparse');
    }
    calibration.free();
  });

  test('what is no network, or the wrong one, is told', async () => {
    throwsTyped(() => calibrateDrive(drive, { ...options('deepego'), network: undefined }), 'needs-weights', 'weights');
    throwsTyped(
      () => calibrateDrive(drive, { ...options('deepego-plus'), network: single }),
      'needs-weights',
      'weights',
    );
    throwsTyped(() => calibrateDrive(drive, { ...options('deepego'), network: 'deepego' }), 'wrong-type', 'network');
    throwsTyped(
      () => calibrateDrive(drive, { ...options('deepego'), network: new Uint8Array(9) }),
      'malformed-weights',
    );
    throwsTyped(() => calibrateDrive(drive, options('deepego-plus', 'recursive')), 'incompatible', 'motion');
    const broken = Uint8Array.from(single);
    broken[broken.length >> 1] ^= 1;
    await rejectsTyped(pool.calibrateDrive(drive, { ...options('deepego'), network: broken }), 'malformed-weights');
  });
});
