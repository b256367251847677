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
  relativeTrajectoryError,
  scanMotion,
  simulateDrive,
  trajectory,
} from 'boresight';
import { createPool } from 'boresight/worker';
import { selected } from '../../dist/lib/drive/view.js';
import glue from '../../dist/wasm/boresight.js';
import { environment, root } from '../../scripts/lib/paths.mjs';
import { program } from '../../scripts/lib/programs.mjs';
import { rejectsTyped, throwsTyped } from './lib/assert.mjs';
import { delphi } from './lib/drives.mjs';
import { assertShape } from './lib/interfaces.mjs';

let pool;
let front;
let four;
before(async () => {
  await Promise.all([init(), initDrives()]);
  pool = createPool({ workers: 1 });
  front = readDrive(delphi());
  four = simulateDrive({ scenario: 'city', seed: 3, durationS: 40, misalignmentDeg: { 3: 2 } });
});
after(() => pool.terminate());

/** The first seconds of a drive of one radar. */
function beginning(drive, untilS) {
  const scans = drive.scans.timeS.findIndex((time) => time > untilS);
  const { timeS, sensor, offsets } = drive.scans;
  return {
    ...drive,
    scans: { timeS: timeS.slice(0, scans), sensor: sensor.slice(0, scans), offsets: offsets.slice(0, scans + 1) },
  };
}

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

describe('trajectories', () => {
  test('with the angle found follow the truth better than with a wrong one', async () => {
    const { frames, mounting, result } = calibrateDrive(four, { sensor: 2 });
    const truth = { timeS: four.motion.timeS, ...four.motion.pose };
    const path = (angleDeg) => trajectory(frames, { ...mounting, angleDeg });
    const ours = path(result.angleDeg);
    assertShape(ours, 'Trajectory');
    const error = relativeTrajectoryError(ours, truth);
    // An angle off by 3 deg turns the car by 3 deg of its way over x: metres after 50 m.
    assert.ok(error < 0.2 * relativeTrajectoryError(path(result.angleDeg + 3), truth), `${error}`);
    assert.equal(await pool.relativeTrajectoryError(ours, truth), error);
    assert.deepEqual(await pool.trajectory(frames, { ...mounting, angleDeg: 1 }), path(1));
    assert.ok(relativeTrajectoryError(truth, truth, 20) < 1e-9);
    // The heading may jump by a turn.
    const jumping = { ...truth, yawDeg: truth.yawDeg.map((yaw, i) => yaw + (i % 2) * 360) };
    assert.ok(relativeTrajectoryError(truth, jumping, 20) < 1e-6);
  });

  test('turn by a yaw rate where one is given', async () => {
    const { frames, mounting, result } = calibrateDrive(four, { sensor: 2 });
    const truth = { timeS: four.motion.timeS, ...four.motion.pose };
    const motion = scanMotion(four);
    const yawRateDegps = Float64Array.from(frames.scan, (scan) => motion.yawRateDegps[scan] - result.biasDegps);
    const path = (angleDeg, options) => trajectory(frames, { ...mounting, angleDeg }, options);
    const error = (angleDeg, options) => relativeTrajectoryError(path(angleDeg, options), truth);
    // A wrong angle then moves the car sideways, 3 deg of 50 m being 2.6 m, where it bent the way before.
    const off = error(result.angleDeg + 3, { yawRateDegps });
    assert.ok(error(result.angleDeg, { yawRateDegps }) < 0.5 && off > 2 && off < 3.2, `${off}`);
    assert.deepEqual(
      await pool.trajectory(frames, { ...mounting, angleDeg: 1 }, { yawRateDegps }),
      path(1, { yawRateDegps }),
    );
    // What is not known follows from the radar's motion.
    assert.deepEqual(path(1, { yawRateDegps: yawRateDegps.map(() => NaN) }), path(1));
    assert.ok(trajectory(frames, { angleDeg: 0, xM: 0 }, { yawRateDegps: yawRateDegps.fill(0) }));
    throwsTyped(() => path(1, { yawRateDegps: new Float64Array(1) }), 'shape', 'options.yawRateDegps');
    throwsTyped(() => path(1, 3), 'wrong-type', 'options');
  });

  test('that cannot be had are null, and bad input is refused', () => {
    const { frames, mounting } = calibrateDrive(four, { sensor: 2 });
    assert.equal(trajectory(frames, { angleDeg: 0, xM: 0 }), null);
    const path = trajectory(frames, { ...mounting, angleDeg: 0 });
    assert.equal(relativeTrajectoryError(path, path, 1e6), null);
    throwsTyped(() => relativeTrajectoryError(path, path, 0), 'wrong-type', 'segmentM');
    throwsTyped(() => relativeTrajectoryError(path, { ...path, xM: new Float64Array(1) }), 'shape', 'truth.xM');
    throwsTyped(
      () => relativeTrajectoryError(path, { ...path, timeS: path.timeS.slice().reverse() }),
      'time-backwards',
      'truth.timeS',
    );
    throwsTyped(() => trajectory(frames, { angleDeg: NaN, xM: 1 }), 'wrong-type', 'mounting.angleDeg');
    throwsTyped(() => trajectory({ ...frames, vxMps: [] }, mounting), 'wrong-type', 'frames.vxMps');
    throwsTyped(() => trajectory(undefined, mounting), 'wrong-type', 'frames');
  });
});

describe('bad drives', () => {
  const part = (name, change) => (drive) => ({ ...drive, [name]: { ...drive[name], ...change(drive[name]) } });
  const spoilt = (array, index, value) => Object.assign(array.slice(), { [index]: value });
  const cases = [
    ['nothing', () => undefined, 'wrong-type', 'drive'],
    ['no scans', ({ scans, ...rest }) => rest, 'wrong-type', 'drive.scans'],
    ['times as a list', part('scans', ({ timeS }) => ({ timeS: [...timeS] })), 'wrong-type', 'drive.scans.timeS'],
    ['too few radars', part('scans', ({ sensor }) => ({ sensor: sensor.subarray(1) })), 'shape', 'drive.scans.sensor'],
    [
      'too few offsets',
      part('scans', ({ offsets }) => ({ offsets: offsets.subarray(1) })),
      'shape',
      'drive.scans.offsets',
    ],
    [
      'offsets that fall',
      part('scans', ({ offsets }) => ({ offsets: spoilt(offsets, 5, 0) })),
      'out-of-range',
      'drive.scans.offsets',
    ],
    [
      'offsets beyond the end',
      part('scans', ({ offsets }) => ({ offsets: spoilt(offsets, offsets.length - 1, 2 ** 32 - 1) })),
      'out-of-range',
      'drive.scans.offsets',
    ],
    [
      'a scan of all detections',
      (drive) => ({
        ...drive,
        scans: {
          timeS: new Float64Array(1),
          sensor: new Uint8Array([1]),
          offsets: new Uint32Array([0, drive.detections.azimuthDeg.length]),
        },
      }),
      'out-of-range',
      'drive.scans.offsets',
    ],
    [
      'time that runs backwards',
      part('scans', ({ timeS }) => ({ timeS: spoilt(timeS, 7, -1) })),
      'time-backwards',
      'drive.scans.timeS',
    ],
    [
      'a time that is none',
      part('scans', ({ timeS }) => ({ timeS: spoilt(timeS, 7, NaN) })),
      'not-finite',
      'drive.scans.timeS',
    ],
    [
      'motion that runs backwards',
      part('motion', ({ timeS }) => ({ timeS: timeS.slice().reverse() })),
      'time-backwards',
      'drive.motion.timeS',
    ],
    [
      'motion without yaw rates',
      part('motion', () => ({ yawRateDegps: undefined })),
      'missing',
      'drive.motion.yawRateDegps',
    ],
    [
      'an azimuth that is none',
      part('detections', ({ azimuthDeg }) => ({ azimuthDeg: spoilt(azimuthDeg, 900, NaN) })),
      'not-finite',
      'drive.detections.azimuthDeg',
    ],
    [
      'a range rate beyond all',
      part('detections', ({ rangeRateMps }) => ({ rangeRateMps: Float64Array.from(rangeRateMps).fill(1e300, 900) })),
      'not-finite',
      'drive.detections.rangeRateMps',
    ],
    [
      'detections of two lengths',
      part('detections', ({ rangeRateMps }) => ({ rangeRateMps: rangeRateMps.slice(1) })),
      'shape',
      'drive.detections.rangeRateMps',
    ],
    [
      'arrays given away',
      (drive) => {
        const azimuthDeg = drive.detections.azimuthDeg.slice();
        structuredClone(azimuthDeg, { transfer: [azimuthDeg.buffer] });
        return { ...drive, detections: { ...drive.detections, azimuthDeg } };
      },
      'shape',
      'drive.detections.rangeRateMps',
    ],
    [
      'a getter that throws',
      (drive) => ({
        ...drive,
        get motion() {
          throw new Error('mine');
        },
      }),
      'wrong-type',
      'drive.motion',
    ],
    ['endless radars', (drive) => ({ ...drive, sensors: new Array(2 ** 32 - 1) }), 'wrong-type', 'drive.sensors'],
    ['a radar without number', (drive) => ({ ...drive, sensors: [{ xM: 1 }] }), 'wrong-type', 'drive.sensors[0].id'],
    [
      'a radar twice',
      (drive) => ({ ...drive, sensors: [...drive.sensors, ...drive.sensors] }),
      'out-of-range',
      'drive.sensors',
    ],
    [
      'a place that is no number',
      (drive) => ({ ...drive, sensors: [{ id: 1, xM: NaN }] }),
      'wrong-type',
      'drive.sensors[0].xM',
    ],
    [
      'a place that is not known',
      (drive) => ({ ...drive, sensors: [{ id: 1, xM: null, yM: null, yawDeg: null }] }),
      'missing',
      'xM',
    ],
  ];
  for (const [name, change, code, what] of cases) {
    test(`${name}: refused, here and in a worker, and the next is calibrated`, async () => {
      const drive = beginning(front, 20);
      const good = calibrateDrive(drive);
      throwsTyped(() => calibrateDrive(change(drive)), code, what);
      await rejectsTyped(pool.calibrateDrive(change(drive)), code, what);
      assert.deepEqual(calibrateDrive(drive), good);
      assert.deepEqual(await pool.calibrateDrive(drive), good);
    });
  }

  test('taken away during the run: refused', () => {
    for (const take of ['timeS', 'offsets', 'azimuthDeg', 'rangeRateMps']) {
      const drive = structuredClone(beginning(front, 60));
      const buffer = (drive.scans[take] ?? drive.detections[take]).buffer;
      const report = (done) => {
        if (done < 200) structuredClone(buffer, { transfer: [buffer] });
      };
      throwsTyped(() => calibrateDrive(drive, {}, report));
    }
    assert.equal(calibrateDrive(beginning(front, 20)).sensor, 1);
  });

  test('options are refused by name', async () => {
    const bad = async (drive, options, code, what) => {
      throwsTyped(() => calibrateDrive(drive, options), code, what);
      await rejectsTyped(pool.calibrateDrive(drive, options), code, what);
    };
    await bad(four, {}, 'missing', 'sensor');
    await bad(four, { sensor: 9 }, 'out-of-range', 'sensor');
    await bad(four, { sensor: 'front' }, 'wrong-type', 'sensor');
    await bad(front, { historyS: 0 }, 'wrong-type', 'historyS');
    await bad(front, { maxGapS: NaN }, 'wrong-type', 'maxGapS');
    await bad(front, { weights: 1 }, 'wrong-type', 'weights');
    await bad(front, { method: 'magic' }, 'unknown-name', 'method');
    await bad(front, { alarmDeg: -1 }, 'out-of-range', 'alarmDeg');
    await bad(front, { colour: 1 }, 'unknown-option', 'colour');
    await bad(front, 5, 'wrong-type', 'options');
    await bad(
      front,
      {
        get sensor() {
          throw new Error('mine');
        },
      },
      'wrong-type',
      'options',
    );
  });

  test('that say nothing are flagged', () => {
    const drive = beginning(front, 20);
    const none = calibrateDrive({
      ...drive,
      motion: { timeS: new Float64Array(0), yawRateDegps: new Float64Array(0) },
    });
    assert.equal(none.result.frames.withoutMotion + none.result.frames.sparse, drive.scans.timeS.length);
    assert.ok(none.result.warnings.some(({ code }) => code === 'no-frames'));
    assert.ok(none.frames.angleDeg.every(Number.isNaN));
    const empty = calibrateDrive({
      ...drive,
      scans: { timeS: new Float64Array(0), sensor: new Uint8Array(0), offsets: new Uint32Array(1) },
    });
    assert.deepEqual([empty.history.timeS.length, empty.result.sigmaDeg], [0, Infinity]);
    const far = calibrateDrive(
      { ...drive, scans: { ...drive.scans, timeS: drive.scans.timeS.map((_, i) => (i < 5 ? -1e308 : 1e308)) } },
      { historyS: 1e-300 },
    );
    assert.equal(far.result.frames.given, drive.scans.timeS.length);
  });
});
