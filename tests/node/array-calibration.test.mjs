import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { Capture, calibrateArray, calibrateBySteeringTable, estimate, init, tiCompensation } from 'boresight';
import { createPool } from 'boresight/worker';
import { batchOf, planeWaves, rejectsTyped, throwsTyped } from './lib/assert.mjs';
import { bin, cfg } from './lib/recording.mjs';

before(() => init());

const at = { rangeBin: 58, dopplerBin: 8 };

describe('the array of a recorded capture', () => {
  let capture;
  let result;
  before(() => {
    capture = new Capture(bin, cfg);
    result = capture.calibrateArray();
  });
  after(() => capture.free());

  test('is calibrated from half of the frames, and checked on the other', () => {
    const { calibration, check, cells, leftOut } = result;
    assert.equal(calibration.method, 'self-calibration');
    assert.equal(calibration.channels.length, 8);
    assert.equal(calibration.frames, 4);
    assert.equal(check.frames, 4);
    assert.ok(calibration.notIdentifiable.includes('direction'));
    assert.equal(cells.filter(({ state }) => state === 'used').length, calibration.cells);
    assert.ok(check.after.residualPhaseDeg < 0.6 * check.before.residualPhaseDeg);
    assert.ok(check.after.residualDb < check.before.residualDb);
    assert.ok(leftOut.residualPhaseDeg < check.before.residualPhaseDeg);
  });

  test("has one target at the board's angle in the other frames", () => {
    const options = { firstFrame: 4, angle: { method: 'nomp' }, calibration: result.calibration };
    const near = ({ detections }) => detections.filter(({ rangeBin }) => rangeBin === 58);
    const calibrated = capture.combineFrames(options);
    assert.equal(calibrated.calibrated, true);
    const [first, ...others] = near(calibrated);
    assert.ok(Math.abs(first.azimuthDeg + 10.8) < 1, `${first.azimuthDeg}`);
    assert.deepEqual(others, []);
    const plain = capture.combineFrames({ ...options, calibration: 'none' });
    assert.equal(plain.calibrated, false);
    assert.ok(near(plain).length > 1);
  });

  test('survives JSON, and corrects snapshots given to estimators', () => {
    const calibration = JSON.parse(JSON.stringify(result.calibration));
    const plain = capture.cellSnapshots(at, { calibration: 'none' });
    const corrected = capture.cellSnapshots(at, { calibration });
    const options = { array: 'awr1642', method: 'bartlett' };
    const one = estimate({ snapshots: plain }, { ...options, calibration });
    const other = estimate({ snapshots: corrected }, options);
    assert.ok(Math.abs(one.sources[0].azimuthDeg - other.sources[0].azimuthDeg) < 1e-9);
  });

  test('is written for the board, which then has the same angles', () => {
    const line = tiCompensation(result.calibration, cfg);
    assert.match(line, /^compRangeBiasAndRxChanPhase 0( -?[\d.]+){16}$/);
    const text = new TextDecoder().decode(cfg).replace(/^compRangeBiasAndRxChanPhase.*$/m, line);
    const compensated = new Capture(bin, text);
    assert.deepEqual(
      compensated.info.config.warnings.map(({ code }) => code),
      ['compensation-applied'],
    );
    const angle = { method: 'bartlett' };
    const [by, given] = [
      compensated.cellSpectrum(at, angle),
      capture.cellSpectrum(at, angle, { calibration: result.calibration }),
    ].map(({ sources }) => sources[0].azimuthDeg);
    assert.ok(Math.abs(by - given) < 0.01, `${by} ${given}`);
    compensated.free();
  });

  test('is stopped by its report, and refuses what is of another array', () => {
    throwsTyped(() => capture.calibrateArray({}, () => false), 'cancelled', 'steps');
    throwsTyped(() => capture.calibrateArray({ frameCount: 9 }), 'out-of-range', 'frameCount');
    const { calibration } = result;
    throwsTyped(() => capture.combineFrames({ array: 'ula8', calibration }), 'other-array', 'calibration');
    throwsTyped(() => capture.combineFrames({ calibration: 'some' }), 'wrong-type', 'calibration');
    const short = { ...calibration, channels: calibration.channels.slice(1) };
    throwsTyped(() => capture.combineFrames({ calibration: short }), 'shape', 'channels');
    const wild = { ...calibration, channels: calibration.channels.map((c) => ({ ...c, gainDb: Number.NaN })) };
    throwsTyped(() => capture.combineFrames({ calibration: wild }), 'out-of-range', 'calibration.channels[0].gainDb');
  });

  test('is calibrated on a pool as here', async () => {
    const pool = createPool({ workers: 1 });
    const steps = [];
    const job = { onProgress: (done, total) => steps.push([done, total]) };
    const there = await pool.captureCalibration(bin, cfg, {}, job);
    assert.deepEqual(there.calibration, result.calibration);
    assert.deepEqual(steps.at(-1), [16, 16]);
    await rejectsTyped(pool.calibrateArray({}, { array: 'ula4' }), 'missing', 'input.snapshots');
    await pool.terminate();
  });
});

describe('cells and tables', () => {
  test('calibrate an array', () => {
    const cells = [10, -20, 35].map((deg) => planeWaves(8, 1, [deg]));
    for (const { data } of cells) for (const part of [6, 7]) data[part] *= 0.5;
    const options = { array: 'ula8' };
    const { calibration } = calibrateArray({ snapshots: batchOf(cells), noisePower: 1e-4 }, options);
    const [gain, other] = [calibration.channels[3].gainDb, calibration.channels[0].gainDb];
    assert.ok(Math.abs(gain - other - 20 * Math.log10(0.5)) < 1e-3, `${gain - other}`);
    const known = { snapshots: batchOf(cells), noisePower: 1e-4, azimuthDeg: [10, -20, 35] };
    assert.equal(calibrateArray(known, options).calibration.method, 'reflector');
    throwsTyped(() => calibrateArray({ ...known, azimuthDeg: [1] }, options), 'shape', 'azimuthDeg');
    throwsTyped(() => calibrateArray(known, { ...options, minSnrDb: 200 }), 'no-calibration-cells', 'cells');
    const table = { azimuthDeg: [0, 30], responses: [0, 30].map((deg) => pairs(planeWaves(4, 1, [deg]).data)) };
    assert.equal(calibrateBySteeringTable(table, 'ula4').calibration.method, 'steering-table');
  });
});

const pairs = (data) => Array.from({ length: data.length / 2 }, (_, k) => [data[2 * k], data[2 * k + 1]]);
