// Drives and options that no calibration can be made of: refused by name, and the next one works.
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { calibrateDrive, init, initDrives, readDrive } from 'boresight';
import { createPool } from 'boresight/worker';
import { rejectsTyped, throwsTyped } from './lib/assert.mjs';
import { beginning, delphi, fourRadars } from './lib/drives.mjs';

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
