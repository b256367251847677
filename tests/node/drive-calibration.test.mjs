// The mounting angle out of whole drives: the same as frame by frame, as in a worker, as on the command line.
import assert from 'node:assert/strict';
import { execFile } from 'node:child_process';
import { after, before, describe, test } from 'node:test';
import { promisify } from 'node:util';
import {
  Calibration,
  calibrateDrive,
  calibrationMethods,
  driveFrame,
  frameVerdicts,
  init,
  initDrives,
  jointCalibration,
  readDrive,
  scanMotion,
} from 'boresight';
import { createPool } from 'boresight/worker';
import { selected } from '../../dist/lib/drive/view.js';
import glue from '../../dist/wasm/boresight.js';
import { environment, root } from '../../scripts/lib/paths.mjs';
import { program } from '../../scripts/lib/programs.mjs';
import { throwsTyped } from './lib/assert.mjs';
import { beginning, delphi, fourRadars } from './lib/drives.mjs';
import { assertShape } from './lib/interfaces.mjs';

let pool;
let front;
let four;
before(async () => {
  await Promise.all([init(), initDrives()]);
  pool = createPool({ workers: 1 });
  front = readDrive(delphi());
  four = fourRadars();
});
after(() => pool.terminate());

/** A drive over and over, each time later. */
function repeated(drive, times) {
  const lengthS =
    Math.max(drive.motion.timeS.at(-1), drive.scans.timeS.at(-1)) -
    Math.min(drive.motion.timeS[0], drive.scans.timeS[0]) +
    0.1;
  const count = drive.scans.offsets.at(-1);
  const all = (part, shift) => {
    const joined = new part.constructor(times * part.length);
    for (let k = 0; k < times; k++) joined.set(shift ? part.map((value) => value + k * shift) : part, k * part.length);
    return joined;
  };
  const { scans, detections, motion } = drive;
  return {
    sensors: drive.sensors,
    scans: {
      timeS: all(scans.timeS, lengthS),
      sensor: all(scans.sensor),
      offsets: Uint32Array.from([...all(scans.offsets.subarray(0, -1), count), times * count]),
    },
    detections: {
      azimuthDeg: all(detections.azimuthDeg.subarray(0, count)),
      rangeRateMps: all(detections.rangeRateMps.subarray(0, count)),
    },
    motion: {
      timeS: all(motion.timeS, lengthS),
      yawRateDegps: all(motion.yawRateDegps),
      speedMps: all(motion.speedMps),
    },
  };
}

describe('calibrateDrive', () => {
  test('gives what the frames give one by one', () => {
    const drive = beginning(front, 60);
    for (const { name: method } of calibrationMethods()) {
      const calibration = new Calibration({ method, xM: 3.4, yM: 0, nominalDeg: 0, minSpeedMps: 3 });
      const found = calibrateDrive(drive, { method, minSpeedMps: 3, weights: true });
      for (const name of ['DriveCalibration', 'AngleHistory', 'CalibratedFrames']) {
        assertShape(
          { DriveCalibration: found, AngleHistory: found.history, CalibratedFrames: found.frames }[name],
          name,
        );
      }
      const { frames, history } = found;
      const next = { history: 0 };
      const motion = scanMotion(drive);
      for (const [index, scan] of frames.scan.entries()) {
        assert.equal(index, scan);
        const outcome = calibration.addFrame(driveFrame(drive, scan, motion));
        assert.equal(frameVerdicts[frames.verdict[index]], outcome.verdict);
        assert.equal(frames.timeS[index], drive.scans.timeS[scan]);
        const [vx, vy] = outcome.motion?.velocityMps ?? [NaN, NaN];
        const row = [vx, vy, outcome.angleDeg ?? NaN, outcome.angleSigmaDeg ?? NaN, outcome.weight].map(Math.fround);
        assert.deepEqual(
          ['vxMps', 'vyMps', 'angleDeg', 'angleSigmaDeg', 'weight'].map((name) => frames[name][index]),
          row,
        );
        assert.equal(frames.inliers[index], outcome.motion?.inliers ?? 0);
        const { offsets, values } = frames.weights;
        assert.deepEqual(values.slice(offsets[index], offsets[index + 1]), outcome.weights);
        if (history.timeS[next.history] === frames.timeS[index]) {
          const { angleDeg, sigmaDeg } = calibration.estimate();
          assert.deepEqual([history.angleDeg[next.history], history.sigmaDeg[next.history]], [angleDeg, sigmaDeg]);
          next.history += 1;
        }
      }
      assert.equal(next.history, history.timeS.length);
      // One a second, but for the methods that are asked after a hundredth of the frames so far at most.
      assert.ok(history.timeS.length >= 59 && history.timeS.length <= 61, `${history.timeS.length}`);
      assert.deepEqual(found.result, calibration.estimate());
      calibration.free();
    }
  });

  test('gives what the command line gives', async () => {
    const boresight = await program('boresight');
    const command = ['calibrate', 'recordings/delphi', '--json', '--min-speed', '3'];
    for (const { name: method } of calibrationMethods()) {
      const { stdout } = await promisify(execFile)(boresight, [...command, '--method', method], {
        cwd: root,
        env: environment,
      });
      const [theirs, { result }] = [JSON.parse(stdout), calibrateDrive(front, { method, minSpeedMps: 3 })];
      // RANSAC takes sines in single precision, whose last bit differs natively: here a draw of one of 12,003
      // frames ends otherwise.
      const limit = method === 'recursive' ? 1e-9 : 1e-7;
      for (const name of ['angleDeg', 'sigmaDeg', 'scale', 'biasDegps', 'inlierShare']) {
        assert.ok(Math.abs(theirs[name] - result[name]) < limit, `${method} ${name}: ${theirs[name]}, ${result[name]}`);
      }
      assert.deepEqual(theirs.frames, result.frames);
      assert.deepEqual(
        theirs.warnings.map(({ code }) => code),
        result.warnings.map(({ code }) => code),
      );
    }
  });

  test('in a worker gives the same, of the drive left whole', async () => {
    for (const sensor of [1, 3]) {
      const options = { sensor, weights: true };
      const here = calibrateDrive(four, options);
      assert.deepEqual(await pool.calibrateDrive(four, options), here);
      assert.ok(here.frames.scan.every((scan) => four.scans.sensor[scan] === sensor));
    }
    assert.ok(four.detections.azimuthDeg.length > 0 && four.motion.timeS.length > 0);
  });

  test('sends a worker the chosen radar alone', () => {
    const { drive, scans } = selected(four, [2]);
    assert.equal(scans.length, four.scans.sensor.filter((id) => id === 2).length);
    const sizes = [...scans].map((scan) => four.scans.offsets[scan + 1] - four.scans.offsets[scan]);
    const total = sizes.reduce((a, b) => a + b);
    assert.deepEqual([drive.detections.azimuthDeg.length, drive.scans.offsets.at(-1)], [total, total]);
    assert.ok(total < four.detections.azimuthDeg.length / 2);
    const frame = driveFrame(drive, 7, scanMotion(drive));
    const { azimuthDeg, rangeRateMps, yawRateDegps, speedMps } = driveFrame(four, scans[7], scanMotion(four));
    assert.deepEqual(
      [frame.azimuthDeg, frame.rangeRateMps, frame.yawRateDegps, frame.speedMps],
      [azimuthDeg, rangeRateMps, yawRateDegps, speedMps],
    );
  });

  test('finds a misaligned radar, and takes its place from the drive unless told otherwise', () => {
    const { result, mounting, sensor, method } = calibrateDrive(four, { sensor: 3 });
    const truth = four.truth.sensors.find(({ id }) => id === 3);
    assert.deepEqual([sensor, method, mounting.xM, mounting.yM], [3, 'recursive', 3.86, 0.7]);
    assert.ok(
      Math.abs(result.angleDeg - truth.yawDeg) < 5 * result.sigmaDeg,
      `${result.angleDeg} +- ${result.sigmaDeg}, ${truth.yawDeg}`,
    );
    assert.equal(result.misaligned, true);
    assert.equal(calibrateDrive(four, { sensor: 3, nominalDeg: truth.yawDeg }).result.misaligned, false);
    assert.equal(calibrateDrive(four, { sensor: 3, xM: 1 }).mounting.xM, 1);
  });

  test('needs no more memory for a longer drive', async () => {
    const { memory } = await glue();
    const [short, long] = [2, 40].map((times) => repeated(beginning(front, 30), times));
    calibrateDrive(short);
    const before = memory.buffer.byteLength;
    assert.equal(calibrateDrive(long).frames.scan.length, 20 * calibrateDrive(short).frames.scan.length);
    assert.equal(memory.buffer.byteLength, before);
  });

  test('tells how far it is, and stops when asked to', async () => {
    const told = [];
    const { frames } = calibrateDrive(front, {}, (...steps) => void told.push(steps));
    const total = frames.scan.length;
    assert.ok(told.length > 50 && told.length <= total / 60, `${told.length}`);
    assert.deepEqual(told.at(-1), [total, total]);
    assert.ok(told.every(([done], i) => i === 0 || done > told[i - 1][0]));
    throwsTyped(() => calibrateDrive(front, {}, (done) => done < 1000), 'cancelled', 'steps');
    throwsTyped(
      () =>
        calibrateDrive(front, {}, () => {
          throw new Error('mine');
        }),
      'cancelled',
    );
    const progress = [];
    await pool.calibrateDrive(front, {}, { onProgress: (...steps) => progress.push(steps) });
    assert.deepEqual(progress, told);
    const controller = new AbortController();
    const job = pool.calibrateDrive(
      repeated(front, 30),
      {},
      { signal: controller.signal, onProgress: () => controller.abort() },
    );
    await assert.rejects(job, { name: 'AbortError' });
    await assert.rejects(pool.calibrateDrive(front, {}, { signal: AbortSignal.abort() }), { name: 'AbortError' });
    assert.equal((await pool.calibrateDrive(beginning(front, 10))).sensor, 1);
  });
});

describe('jointCalibration', () => {
  test('gives the radars one scale and bias, in a worker too', async () => {
    const radars = jointCalibration(four, { weights: true });
    assert.deepEqual(
      radars.map(({ sensor }) => sensor),
      [1, 2, 3, 4],
    );
    for (const { sensor, result, frames, method } of radars) {
      const truth = four.truth.sensors.find(({ id }) => id === sensor);
      assert.ok(
        Math.abs(result.angleDeg - truth.yawDeg) < 5 * result.sigmaDeg,
        `${result.angleDeg} +- ${result.sigmaDeg}, ${truth.yawDeg}`,
      );
      assert.deepEqual(
        [result.scale, result.biasDegps, method],
        [radars[0].result.scale, radars[0].result.biasDegps, 'recursive'],
      );
      assert.equal(result.frames.given, frames.scan.length);
      assert.ok(frames.scan.every((scan) => four.scans.sensor[scan] === sensor));
    }
    assert.deepEqual(await pool.jointCalibration(four, { weights: true }), radars);
    const [some] = await pool.jointCalibration(four, { sensors: [{ sensor: 4, xM: 3, nominalDeg: 80 }, 2] });
    assert.deepEqual([some.sensor, some.mounting.xM, some.mounting.nominalDeg], [4, 3, 80]);
  });

  test('of one radar is its recursive estimate', () => {
    const [one] = jointCalibration(four, { sensors: [2] });
    const alone = calibrateDrive(four, { sensor: 2 });
    assert.deepEqual(one.frames, alone.frames);
    assert.ok(Math.abs(one.result.angleDeg - alone.result.angleDeg) < 1e-9);
  });

  test('refuses radars by name', () => {
    const bad = (sensors, code, what) => throwsTyped(() => jointCalibration(four, { sensors }), code, what);
    bad([], 'wrong-type', 'sensors');
    bad([7], 'out-of-range', 'sensors[0]');
    bad(['1'], 'wrong-type', 'sensors[0]');
    bad([1, 1], 'out-of-range', 'sensors');
    bad([{ sensor: 1, xm: 2 }], 'unknown-option', 'sensors[0].xm');
    throwsTyped(() => jointCalibration(four, { method: 'kabsch' }), 'unknown-option', 'method');
  });
});
