// Drives: read from files, simulated, and looked at frame by frame.
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { gunzipSync } from 'node:zlib';
import {
  Calibration,
  driveFrame,
  driveScenarios,
  init,
  initDrives,
  readDrive,
  scanMotion,
  simulateDrive,
} from 'boresight';
import { createPool } from 'boresight/worker';
import { rejectsTyped, throwsTyped } from './lib/assert.mjs';
import { delphi, golden } from './lib/drives.mjs';
import { assertShape } from './lib/interfaces.mjs';

let pool;
before(async () => {
  await Promise.all([init(), initDrives()]);
  pool = createPool({ workers: 1 });
});
after(() => pool.terminate());

const text = (string) => new TextEncoder().encode(string);
const detections = 'time_s,azimuth_deg,range_rate_mps,sensor\n0,10,-3,2\n0,-20,-3.5,2\n0.05,5,-4,1\n';
const motion = 'time_s,yaw_rate_degps\n0,1\n0.2,3\n';
const table = (name, string) => ({ name, bytes: text(string) });
const csv = () => [table('radar.csv', detections), table('car.csv', motion)];

/** A drive's parts fit together. */
function assertWhole(drive) {
  for (const [part, name] of [
    [drive.scans, 'DriveScans'],
    [drive.counts, 'DriveCounts'],
  ])
    assertShape(part, name);
  drive.sensors.forEach((sensor) => assertShape(sensor, 'DriveSensor'));
  const { timeS, sensor, offsets } = drive.scans;
  const count = drive.detections.azimuthDeg.length;
  assert.deepEqual(
    [sensor.length, offsets.length, offsets[0], offsets.at(-1)],
    [timeS.length, timeS.length + 1, 0, count],
  );
  assert.ok(timeS.every((time, i) => i === 0 || time >= timeS[i - 1]));
  assert.ok(sensor.every((id) => drive.sensors.some((known) => known.id === id)));
  for (const column of ['rangeRateMps', 'rangeM', 'rcsDbsm'])
    assert.equal(drive.detections[column].length, count, column);
  for (const column of ['yawRateDegps', 'speedMps'])
    assert.equal(drive.motion[column].length, drive.motion.timeS.length, column);
}

describe('readDrive', () => {
  test('reads the Delphi tracks and counts what it leaves out', async () => {
    const drive = readDrive(delphi());
    assertShape(drive, 'Drive');
    assertWhole(drive);
    assert.equal(drive.format, 'delphi');
    assert.equal(drive.scans.timeS.length, 12_003);
    assert.equal(drive.counts.detections, drive.detections.azimuthDeg.length + drive.counts.dropped['invalid-marker']);
    assert.equal(drive.detections.label, null);
    assert.ok(drive.motion.pose.xM.every(Number.isFinite));
    assert.deepEqual(await pool.readDrive(delphi()), drive);
    const plain = delphi().map(({ name, bytes }) => ({
      name: name.replace('.gz', ''),
      bytes: new Uint8Array(gunzipSync(bytes)).buffer,
    }));
    assert.deepEqual(readDrive(plain), drive);
  });

  test('reads the general tables, files in any order, and names those it leaves out', () => {
    const drive = readDrive([table('notes.txt', 'hello'), ...csv().reverse()]);
    assertWhole(drive);
    assert.equal(drive.format, 'csv');
    assert.deepEqual(
      drive.sensors,
      [1, 2].map((id) => ({ id, xM: null, yM: null, yawDeg: null })),
    );
    assert.deepEqual([...drive.scans.sensor], [2, 1]);
    // Azimuths pass through single precision in radians.
    [10, -20, 5].forEach((deg, i) => assert.ok(Math.abs(drive.detections.azimuthDeg[i] - deg) < 2e-6));
    assert.ok(drive.detections.rangeM.every(Number.isNaN) && drive.motion.speedMps.every(Number.isNaN));
    assert.equal(drive.motion.pose, null);
    assert.deepEqual(
      drive.warnings.map(({ code }) => code),
      ['ignored-file'],
    );
  });

  test('reads RadarScenes, whichever way its datasets are stored', () => {
    const [drive, ...others] = ['contiguous', 'deflated', 'latest_filtered'].map((name) =>
      readDrive([golden(`${name}.h5`)]),
    );
    assertWhole(drive);
    assert.equal(drive.format, 'radarscenes');
    assert.ok(drive.detections.label instanceof Uint8Array && drive.motion.pose !== null);
    const known = drive.sensors.find(({ id }) => id === 2);
    assert.deepEqual([known.xM, known.yM], [3.86, -0.7]);
    for (const other of others) assert.deepEqual(other, drive);
    assert.deepEqual([drive.mountings, drive.counts.incompleteDetections], ['format', 1]);
    const sensors = table('set/sensors.json', '{"radar_2": {"x": 1, "y": 2, "yaw": 0.5}}');
    const stated = readDrive([sensors, golden('contiguous.h5')]);
    assert.equal(stated.mountings, 'sensors-json');
    assert.deepEqual(
      stated.sensors.map(({ xM }) => xM),
      [null, 1],
    );
    assert.throws(() => readDrive([table('sensors.json', '{'), golden('contiguous.h5')]), { code: 'malformed-json' });
  });

  test('refuses what is no drive with a typed error, and reads on', async () => {
    const bad = (files, code, what, options) => throwsTyped(() => readDrive(files, options), code, what);
    bad([], 'no-drive-log', 'drive log');
    bad([table('a.txt', 'x'), table('b.json', '{}')], 'no-drive-log');
    bad(csv(), 'no-drive-log', undefined, { format: 'delphi' });
    bad(csv(), 'unknown-name', 'format', { format: 'rosbag' });
    bad(csv(), 'unknown-option', 'from', { from: 1 });
    bad([table('radar.csv', 'time_s,azimuth_deg\n0,1\n')], 'malformed-table');
    bad([table('radar.csv', detections.replace('0.05,', '-1,').replace(',1\n', ',2\n'))], 'time-backwards');
    bad([golden('backwards.h5')], 'time-backwards');
    bad([golden('no_vr.h5')], 'malformed-hdf5');
    bad([golden('no_odometry.h5')], 'malformed-hdf5');
    const whole = golden('deflated.h5');
    for (const length of [0, 7, 500, 2000, 4000])
      bad([{ ...whole, bytes: whole.bytes.subarray(0, length) }], 'malformed-hdf5');
    const [radar] = delphi();
    bad([{ ...radar, bytes: radar.bytes.subarray(0, 1000) }], 'malformed-gzip');
    bad(undefined, 'wrong-type', 'files');
    bad([{ name: 'a.csv' }], 'missing', 'files[0].bytes');
    bad([{ name: 1, bytes: text('') }], 'wrong-type', 'files[0].name');
    bad([{ name: 'a.csv', bytes: [1] }], 'wrong-type', 'files[0].bytes');
    bad(
      [
        {
          get name() {
            throw new Error('mine');
          },
          bytes: text(''),
        },
      ],
      'wrong-type',
      'files[0].name',
    );
    bad(new Array(2 ** 32 - 1), 'wrong-type', 'files');
    await rejectsTyped(pool.readDrive([]), 'no-drive-log');
    assert.equal(readDrive(csv()).scans.timeS.length, 2);
    assert.equal((await pool.readDrive(csv())).scans.timeS.length, 2);
  });
});

describe('simulateDrive', () => {
  const options = {
    scenario: 'dense-traffic',
    seed: 5n,
    durationS: 4,
    misalignmentDeg: { 2: 1.5 },
    movingShare: 0.4,
    noise: { clutter: 2 },
  };

  test('gives the same drive every time, with its truth', async () => {
    const drive = simulateDrive(options);
    assertShape(drive, 'SimulatedDrive');
    assertShape(drive.truth, 'DriveTruth');
    assertWhole(drive);
    const count = drive.detections.azimuthDeg.length;
    assert.deepEqual(
      [drive.truth.moving.length, drive.truth.track.length, drive.counts.detections],
      [count, count, count],
    );
    drive.sensors.forEach((sensor, i) => {
      const misalignment = drive.truth.sensors[i].yawDeg - sensor.yawDeg;
      assert.ok(Math.abs(misalignment - (sensor.id === 2 ? 1.5 : 0)) < 1e-9);
    });
    // Static in the numbers of RadarScenes is 11.
    assert.ok(drive.detections.label.every((label, i) => (label !== 11) === (drive.truth.moving[i] === 1)));
    assert.ok(drive.truth.moving.includes(1));
    assert.deepEqual(simulateDrive(options), drive);
    assert.deepEqual(await pool.simulateDrive(options), drive);
    assert.notDeepEqual(simulateDrive({ ...options, seed: 6 }).detections, drive.detections);
  });

  test('lists its scenarios', async () => {
    const scenarios = driveScenarios();
    scenarios.forEach((scenario) => assertShape(scenario, 'DriveScenarioInfo'));
    for (const { name } of scenarios) assert.ok(simulateDrive({ scenario: name, durationS: 1 }).scans.timeS.length > 0);
    assert.deepEqual(await pool.driveScenarios(), scenarios);
  });

  test('tells how far it is and stops when asked to', async () => {
    const told = [];
    throwsTyped(
      () =>
        simulateDrive({ durationS: 20 }, (done, total) => {
          told.push([done, total]);
          return done < 200;
        }),
      'cancelled',
    );
    assert.ok(told.length > 1 && told.every(([done, total]) => done < total && total > 1000), JSON.stringify(told));
    const progress = [];
    await pool.simulateDrive({ durationS: 20 }, { onProgress: (...steps) => progress.push(steps) });
    assert.deepEqual(progress.at(-1)[0], progress.at(-1)[1]);
    const controller = new AbortController();
    // Minutes of work.
    const job = pool.simulateDrive(
      { durationS: 3600 },
      { signal: controller.signal, onProgress: () => controller.abort() },
    );
    await assert.rejects(job, { name: 'AbortError' });
  });

  test('refuses options by name', () => {
    const bad = (change, code, what) => throwsTyped(() => simulateDrive({ ...options, ...change }), code, what);
    bad({ scenario: 'moon' }, 'unknown-name', 'scenario');
    bad({ durationS: 1e9 }, 'out-of-range', 'durationS');
    bad({ seed: -1 }, 'out-of-range', 'seed');
    bad({ movingShare: 0.95 }, 'out-of-range', 'movingShare');
    bad({ misalignmentDeg: { 9: 1 } }, 'out-of-range');
    bad({ misalignmentDeg: { two: 1 } }, 'wrong-type', 'misalignmentDeg');
    bad({ misalignmentDeg: [1] }, 'wrong-type', 'misalignmentDeg');
    bad({ sensors: [] }, 'empty', 'sensors');
    bad({ sensors: [{ id: 256, xM: 1, yM: 0, yawDeg: 0 }] }, 'out-of-range', 'sensors[0].id');
    bad({ sensors: new Array(1e9) }, 'wrong-type', 'sensors');
    bad({ noise: { clutter: -1 } }, 'out-of-range');
    bad({ noise: { wind: 1 } }, 'unknown-option', 'noise.wind');
    bad({ colour: 'red' }, 'unknown-option', 'colour');
  });
});

describe('driveFrame', () => {
  test('gives views with the motion at its time, ready for addFrame', async () => {
    const drive = readDrive(csv());
    const motion = scanMotion(drive);
    const frame = driveFrame(drive, 1, motion);
    assertShape(frame, 'DriveFrame');
    assert.equal(frame.sensor, 1);
    assert.equal(frame.azimuthDeg.buffer, drive.detections.azimuthDeg.buffer);
    assert.deepEqual([frame.azimuthDeg.length, frame.rangeRateMps[0]], [1, -4]);
    assert.ok(Math.abs(frame.yawRateDegps - 1.5) < 1e-12);
    assert.equal(frame.speedMps, null);
    assert.equal(driveFrame(drive, 1, scanMotion(drive, { maxGapS: 0.05 })).yawRateDegps, null);
    assertShape(motion, 'ScanMotion');
    assert.deepEqual(await pool.scanMotion(drive), motion);
    assert.deepEqual(await pool.driveFrame(drive, 1, motion), frame);
    const calibration = new Calibration({ method: 'recursive', xM: 3 });
    assert.equal(calibration.addFrame(frame).verdict, 'sparse');
    calibration.free();
  });

  test('refuses what is no scan', () => {
    const drive = readDrive(csv());
    const motion = scanMotion(drive);
    for (const scan of [-1, 2, 0.5, Number.NaN, '0', undefined])
      throwsTyped(() => driveFrame(drive, scan, motion), 'out-of-range', 'scan');
    throwsTyped(() => driveFrame(null, 0, motion), 'wrong-type', 'drive');
    throwsTyped(() => driveFrame(drive, 0), 'wrong-type', 'motion');
    throwsTyped(() => driveFrame(drive, 0, { maxGapS: 1 }), 'missing', 'motion.yawRateDegps');
    const short = { ...motion, speedMps: new Float64Array(1) };
    throwsTyped(() => driveFrame(drive, 0, short), 'shape', 'motion.speedMps');
    throwsTyped(() => scanMotion(drive, { maxGapS: -1 }), 'wrong-type', 'maxGapS');
    throwsTyped(() => scanMotion(null), 'wrong-type', 'drive');
    const backwards = { ...drive, motion: { ...drive.motion, timeS: drive.motion.timeS.slice().reverse() } };
    throwsTyped(() => scanMotion(backwards), 'time-backwards', 'drive.motion.timeS');
  });
});
