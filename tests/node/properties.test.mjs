// Whatever comes in, it is answered or refused with a typed error, and the instance works on.
import assert from 'node:assert/strict';
import { beforeEach, describe, test } from 'node:test';
import * as boresight from 'boresight';
import fc from 'fast-check';
import { assertTargets, bin, cfg, dat } from './lib/recording.mjs';

const { BoresightError } = boresight;
const settings = { seed: 20_240_601, numRuns: 150 };

/** Runs `work`; it must return or throw a typed error that is no trap. */
function answered(work) {
  try {
    return work();
  } catch (error) {
    assert.ok(error instanceof BoresightError, `${error?.stack}`);
    assert.notEqual(error.code, 'trap', error.message);
    assert.ok(error.code && error.message && error.details.what, JSON.stringify(error));
    return undefined;
  }
}

const numbers = fc.oneof(
  fc.double(),
  fc.integer(),
  fc.constantFrom(0, -0, 1, -1, Number.NaN, Infinity, -Infinity, 1e308, 5e-324, 2 ** 32, 2 ** 53),
);
const anything = fc.oneof(
  numbers,
  fc.string(),
  fc.boolean(),
  fc.constantFrom(null, undefined, [], {}),
  fc.bigInt(),
  fc.anything(),
);
const methods = fc.constantFrom(
  'bartlett',
  'capon',
  'music',
  'single-snapshot-music',
  'root-music',
  'esprit',
  'min-norm',
  'coarray-music',
  'iaa',
  'nomp',
  'atomic-norm',
  'maximum-likelihood',
  'sparse-bayesian',
);

/** Options of which some fields are replaced by anything. */
const spoilt = (record) =>
  fc.record(
    Object.fromEntries(
      Object.entries(record).map(([key, good]) => [
        key,
        fc.oneof({ weight: 9, arbitrary: good }, { weight: 1, arbitrary: anything }),
      ]),
    ),
    { requiredKeys: [] },
  );

beforeEach(() => Promise.all([boresight.init(), boresight.initDrives()]));

const typed = (error) => assert.ok(error instanceof boresight.BoresightError, `a BoresightError, not ${error}`);

describe('anything at all', () => {
  const functions = Object.entries(boresight).filter(
    ([name, value]) => typeof value === 'function' && !/^(init.*|BoresightError|simulateDrive)$/.test(name),
  ); // a drive by default takes long

  for (const [name, value] of functions) {
    test(`${name} answers or refuses`, () => {
      const isClass = /^class /.test(Function.prototype.toString.call(value));
      fc.assert(
        fc.property(fc.array(anything, { maxLength: 3 }), (args) => {
          const made = answered(() => (isClass ? new value(...args) : value(...args)));
          made?.free?.();
          // A refusal that comes later is typed too: what is thrown here fails the file.
          if (made instanceof Promise) made.catch(typed);
        }),
        settings,
      );
      assert.equal(boresight.array('ula8').positions.length, 8);
    });
  }
});

describe('estimators', () => {
  const options = spoilt({
    method: methods,
    array: fc.constantFrom('ula4', 'ula8', 'awr1843', 'lrr48', {
      positions: [
        [0, 0, 0],
        [0, 0.7, 0],
        [0, 1.9, 0.3],
      ],
    }),
    sources: fc.oneof(fc.nat(9), fc.constantFrom('aic', 'mdl', 'network')),
    fieldOfViewDeg: fc.integer({ min: 1, max: 90 }),
    gridPoints: fc.integer({ min: 16, max: 300 }),
    elevationPoints: fc.integer({ min: 3, max: 9 }),
    forwardBackward: fc.boolean(),
    smoothing: fc.nat(9),
    loading: fc.constantFrom(0, 1e-3, 1),
    maxIterations: fc.integer({ min: 1, max: 20 }),
  });
  const data = fc.record({
    elements: fc.constantFrom(4, 8, 12, 48, 3, 0, 1),
    snapshots: fc.constantFrom(1, 2, 10, 0),
    values: fc.array(
      fc.oneof(
        { weight: 20, arbitrary: fc.double({ min: -1, max: 1, noNaN: true }) },
        { weight: 1, arbitrary: numbers },
      ),
      { minLength: 1, maxLength: 20 },
    ),
    asCovariance: fc.boolean(),
    single: fc.boolean(),
  });

  test('answer or refuse any options and data, and what they answer is finite', () => {
    fc.assert(
      fc.property(options, data, (options, { elements, snapshots, values, asCovariance, single }) => {
        const Type = single ? Float32Array : Float64Array;
        const columns = asCovariance ? elements : snapshots;
        const data = Type.from({ length: 2 * elements * columns }, (_, i) => values[i % values.length]);
        if (asCovariance) {
          // Hermitian, so that more than the first check is met.
          for (let i = 0; i < elements; i++) {
            for (let k = 0; k <= i; k++) {
              data[2 * (k * elements + i)] = data[2 * (i * elements + k)];
              data[2 * (k * elements + i) + 1] = i === k ? 0 : -data[2 * (i * elements + k) + 1];
            }
            data[2 * (i * elements + i)] = 10 * Math.abs(data[2 * (i * elements + i)]);
          }
        }
        const matrix = { data, shape: [elements, columns] };
        const input = asCovariance ? { covariance: matrix, snapshotCount: 5 } : { snapshots: matrix };
        const result = answered(() => boresight.estimate(input, options));
        if (result === undefined) return;
        for (const { azimuthDeg, elevationDeg, powerDb } of result.sources) {
          assert.ok(
            [azimuthDeg, elevationDeg, powerDb].every(Number.isFinite),
            JSON.stringify([options, result.sources]),
          );
          assert.ok(Math.abs(azimuthDeg) <= 90 + 1e-9);
        }
        if (result.spectrum) assert.ok(result.spectrum.valuesDb.every(Number.isFinite), JSON.stringify(options));
      }),
      { ...settings, numRuns: 400 },
    );
  });
});

describe('files', () => {
  /** A file with some bytes changed, cut off or put in. */
  const damaged = (file) =>
    fc
      .record({
        changes: fc.array(fc.tuple(fc.nat(file.length - 1), fc.nat(255)), { maxLength: 8 }),
        from: fc.oneof({ weight: 3, arbitrary: fc.constant(0) }, { weight: 1, arbitrary: fc.nat(file.length) }),
        length: fc.oneof(
          { weight: 3, arbitrary: fc.constant(file.length) },
          { weight: 1, arbitrary: fc.nat(file.length) },
        ),
      })
      .map(({ changes, from, length }) => {
        const copy = Uint8Array.from(file);
        for (const [at, byte] of changes) copy[at] = byte;
        return copy.subarray(from, from + length);
      });

  test('of captures and configurations, damaged, are processed or refused', () => {
    const oneFrame = bin.subarray(0, 140_000);
    fc.assert(
      fc.property(damaged(oneFrame), damaged(cfg), (bytes, text) => {
        const capture = answered(() => new boresight.Capture(bytes, text));
        if (capture === undefined) return;
        answered(() => capture.processFrame(0));
        capture.free();
      }),
      { ...settings, numRuns: 60 },
    );
    const capture = new boresight.Capture(bin, cfg);
    assertTargets(capture.processFrame(0).detections);
    capture.free();
  });

  test('of the board, damaged, are read as far as they go', () => {
    fc.assert(
      fc.property(damaged(dat.subarray(0, 20_000)), (bytes) => {
        const log = boresight.parseBoardLog(bytes, cfg);
        assert.ok(log.skippedBytes <= bytes.length);
      }),
      settings,
    );
  });

  test('of arrays come back as they were written', () => {
    const array = fc
      .tuple(
        fc.constantFrom('real', 'complex'),
        fc.boolean(),
        fc.array(fc.integer({ min: 1, max: 5 }), { minLength: 1, maxLength: 4 }),
      )
      .map(([kind, single, shape]) => {
        const length = shape.reduce((a, b) => a * b, kind === 'complex' ? 2 : 1);
        return { kind, data: (single ? Float32Array : Float64Array).from({ length }, (_, i) => i / 7 - 3), shape };
      });
    fc.assert(
      fc.property(array, (array) => assert.deepEqual(boresight.readNpy(boresight.writeNpy(array)), array)),
      settings,
    );
    const npy = boresight.writeNpy({ kind: 'real', data: Float64Array.of(1, 2, 3), shape: [3] });
    fc.assert(
      fc.property(damaged(npy), (bytes) => {
        answered(() => boresight.readNpy(bytes));
      }),
      settings,
    );
  });
});

describe('drives', () => {
  test('are simulated or refused, whatever the options', () => {
    const options = spoilt({
      scenario: fc.constantFrom('city', 'country-road', 'motorway', 'car-park', 'stop-and-go', 'dense-traffic'),
      seed: fc.nat(),
      durationS: fc.constantFrom(1, 1.5),
      sensors: fc.array(
        spoilt({
          id: fc.nat(5),
          xM: fc.double({ min: -5, max: 5, noNaN: true }),
          yM: fc.constant(0),
          yawDeg: fc.nat(360),
        }),
        { maxLength: 3 },
      ),
      misalignmentDeg: fc.dictionary(fc.constantFrom('0', '1', '2'), numbers, { maxKeys: 2 }),
      movingShare: fc.constantFrom(0, 0.3, 0.8),
      noise: spoilt({
        clutter: fc.nat(50),
        ghostShare: fc.double({ min: 0, max: 0.5, noNaN: true }),
        azimuthSigmaDeg: fc.nat(10),
      }),
      yawRateScale: fc.double({ min: 0.5, max: 2, noNaN: true }),
      yawRateBiasDegps: numbers,
      slipGradientDeg: fc.double({ min: -1, max: 1, noNaN: true }),
    });
    // Stopped at the first report, but for short ones, so that no run lasts.
    const report = (done, total) => done === 0 && total < 500;
    fc.assert(
      fc.property(options, (options) => {
        const drive = answered(() => boresight.simulateDrive(options, report));
        if (drive) assert.ok(drive.detections.azimuthDeg.every(Number.isFinite));
      }),
      settings,
    );
  });

  test('are calibrated or refused, whatever they hold', () => {
    const good = boresight.simulateDrive({ durationS: 3, seed: 2 });
    const { scans, detections, motion } = good;
    const spoiltArray = (array) =>
      fc.oneof(
        { weight: 9, arbitrary: fc.constant(array) },
        { weight: 1, arbitrary: anything },
        {
          weight: 3,
          arbitrary: fc
            .tuple(fc.nat(array.length - 1), numbers)
            .map(([at, value]) => Object.assign(array.slice(), { [at]: value })),
        },
        { weight: 1, arbitrary: fc.nat(array.length).map((length) => array.subarray(0, length)) },
      );
    const of = (part) =>
      fc.record(Object.fromEntries(Object.entries(part).map(([key, array]) => [key, spoiltArray(array)])));
    const { azimuthDeg, rangeRateMps } = detections;
    const { timeS, yawRateDegps, speedMps } = motion;
    const drive = fc.record({
      sensors: fc.oneof({ weight: 9, arbitrary: fc.constant(good.sensors) }, { weight: 1, arbitrary: anything }),
      scans: of(scans),
      detections: of({ azimuthDeg, rangeRateMps }),
      motion: of({ timeS, yawRateDegps, speedMps }),
    });
    const options = spoilt({
      sensor: fc.constantFrom(1, 2, 3, 4),
      method: fc.constantFrom(...boresight.calibrationMethods().map(({ name }) => name)),
      historyS: numbers,
      maxGapS: numbers,
      weights: fc.boolean(),
      xM: numbers,
      nominalDeg: numbers,
    });
    const shared = boresight.jointCalibration(good);
    fc.assert(
      fc.property(drive, options, (drive, options) => {
        const found = answered(() => boresight.calibrateDrive(drive, options));
        answered(() => boresight.jointCalibration(drive));
        answered(() => boresight.driveFrame(drive, 3, boresight.scanMotion(drive)));
        if (!found) return;
        assert.equal(found.result.frames.given, found.frames.scan.length);
        assert.ok(
          !Number.isNaN(found.result.angleDeg) && !Number.isNaN(found.result.sigmaDeg),
          JSON.stringify(found.result),
        );
        answered(() => boresight.trajectory(found.frames, { ...found.mounting, angleDeg: found.result.angleDeg }));
      }),
      { ...settings, numRuns: 400 },
    );
    assert.deepEqual(boresight.jointCalibration(good), shared);
  });
});
