// Files that people hold: point clouds as drives, the signs of a drive, arrays of MATLAB and HDF5.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, describe, test } from 'node:test';
import { calibrateDrive, init, initDrives, listArrays, readArray, readDrive } from 'boresight';
import { createPool } from 'boresight/worker';
import { throwsTyped } from './lib/assert.mjs';
import { clouds } from './lib/clouds.mjs';
import { delphi } from './lib/drives.mjs';
import { assertShape } from './lib/interfaces.mjs';

let pool;
before(async () => {
  await Promise.all([init(), initDrives()]);
  pool = createPool({ workers: 1 });
});
after(() => pool.terminate());

const golden = (name) => readFileSync(new URL(`../golden/hdf5/${name}`, import.meta.url));
const codes = (drive) => drive.warnings.map(({ code }) => code);
const message = (drive, code) => drive.warnings.find((warning) => warning.code === code)?.message;

describe('point clouds', () => {
  test('with the tables of nuScenes are a drive that calibrates', async () => {
    const drive = readDrive(clouds());
    assertShape(drive, 'Drive');
    assert.equal(drive.format, 'pcd');
    assert.equal(drive.mountings, 'calibrated-sensor');
    assert.deepEqual(codes(drive), ['differentiated-poses', 'radar-names']);
    assert.equal(drive.scans.timeS.length, 400);
    assert.equal(drive.motion.timeS.length, 400);
    const { result } = calibrateDrive(drive);
    assert.ok(Math.abs(result.angleDeg - 2) < 0.1, `${result.angleDeg}`);
    assert.deepEqual(await pool.readDrive(clouds()), drive);
  });

  test('of two recordings, or cut, are refused', () => {
    const [first, second] = clouds({ seconds: 0.1 });
    const cut = { name: first.name, bytes: first.bytes.subarray(0, first.bytes.length - 60) };
    throwsTyped(() => readDrive([cut]), 'malformed-file');
    throwsTyped(() => readDrive([first, { ...second, name: second.name.replace('n015', 'n008') }]), 'no-drive-log');
    throwsTyped(() => readDrive([first], { format: 'csv' }), 'no-drive-log');
  });
});

describe('signs', () => {
  const mean = (values) => values.reduce((sum, value) => sum + value, 0) / values.length;

  test('are as the options say', () => {
    const usual = readDrive(clouds({ seconds: 1 }));
    const turned = readDrive(clouds({ seconds: 1 }), { azimuthSign: 'right', rangeRateSign: 'approaching' });
    assert.deepEqual(
      turned.detections.azimuthDeg,
      usual.detections.azimuthDeg.map((angle) => -angle),
    );
    assert.deepEqual(
      turned.detections.rangeRateMps,
      usual.detections.rangeRateMps.map((rate) => -rate),
    );
    throwsTyped(() => readDrive(clouds({ seconds: 1 }), { azimuthSign: 'up' }), 'unknown-name', 'azimuthSign');
  });

  test('are found out of a recorded drive, and turned round where they are wrong', () => {
    const auto = { azimuthSign: 'auto', rangeRateSign: 'auto' };
    const found = readDrive(delphi(), auto);
    assert.match(message(found, 'azimuth-sign'), /positive to the left .*nothing was changed/);
    assert.match(message(found, 'range-rate-sign'), /positive when receding .*nothing was changed/);
    assert.deepEqual(found.detections, readDrive(delphi()).detections);
  });

  test('mirrored clouds are mirrored back', () => {
    const mirrored = clouds({ sign: -1 });
    const drive = readDrive(mirrored, { azimuthSign: 'auto' });
    assert.match(message(drive, 'azimuth-sign'), /positive to the right .*all were turned round/);
    assert.ok(mean(drive.detections.azimuthDeg) - mean(readDrive(clouds()).detections.azimuthDeg) < 1e-6);
    assert.ok(Math.abs(calibrateDrive(drive).result.angleDeg - 2) < 0.1);
  });
});

describe('readArray', () => {
  test('reads variables of MATLAB in its order of axes', async () => {
    const bytes = golden('matlab.mat');
    const entries = listArrays(bytes);
    entries.forEach((entry) => assertShape(entry, 'ArrayEntry'));
    assert.deepEqual(
      entries.map(({ dataset, shape }) => [dataset, ...shape]),
      [
        ['X', 3, 2],
        ['counts', 1, 3],
        ['cube', 2, 3, 4, 2],
        ['single', 1, 2],
        ['board/gain', 1, 2],
      ],
    );
    const x = readArray(bytes, { dataset: 'X' });
    assertShape(x, 'NpyArray');
    assert.deepEqual(x, {
      kind: 'complex',
      data: Float64Array.of(11, 11.5, 12, 12.5, 21, 21.5, 22, 22.5, 31, 31.5, 32, 32.5),
      shape: [3, 2],
    });
    assert.deepEqual(await pool.readArray(bytes, { dataset: 'X' }), x);
    assert.deepEqual(await pool.listArrays(bytes), entries);
  });

  test('reads the only array of a file, and refuses what is none', () => {
    assert.deepEqual(readArray(golden('one.h5')).shape, [3, 2]);
    const { details } = throwsTyped(() => readArray(golden('matlab.mat')), 'malformed-hdf5');
    assert.match(details.expected, /X \[3, 2\], counts \[1, 3\]/);
    throwsTyped(() => readArray(Buffer.from('MATLAB 5.0 MAT-file, Platform'.padEnd(200))), 'malformed-hdf5');
    throwsTyped(() => readArray(new Uint8Array()), 'malformed-hdf5');
    throwsTyped(() => readArray(golden('one.h5'), { name: 'x' }), 'unknown-option');
    throwsTyped(() => readArray('text'), 'wrong-type');
  });
});
