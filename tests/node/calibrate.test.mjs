// The mounting angle out of frames made here: a car on a winding road, a radar that sees standing points.
import assert from 'node:assert/strict';
import { before, describe, test } from 'node:test';
import { Calibration, calibrationMethods, init, initDrives, mergeCalibrations } from 'boresight';
import { createPool } from 'boresight/worker';
import glue from '../../dist/wasm/boresight_drives.js';
import { throwsTyped } from './lib/assert.mjs';
import { assertShape } from './lib/interfaces.mjs';

before(() => Promise.all([init(), initDrives()]));

const rad = Math.PI / 180;
const radar = { method: 'least-squares', xM: 3.86, yM: 0.7 };

/** Numbers in [0, 1) by a linear congruential generator. */
function random(seed) {
  let state = seed;
  return () => {
    state = (Math.imul(state, 1_664_525) + 1_013_904_223) >>> 0;
    return state / 2 ** 32;
  };
}

/** Frame `index` of a drive, every fifth detection moving; `scale` is that of the yaw rate. */
function frame(index, angleDeg, { scale = 1, detections = 40 } = {}) {
  const next = random(index + 1);
  const timeS = index * 0.06;
  const speedMps = 10 + 2 * Math.sin(timeS / 3);
  const yawRate = 15 * rad * Math.sin(timeS / 2);
  const [u, v] = [speedMps - yawRate * radar.yM, yawRate * radar.xM];
  const [sine, cosine] = [Math.sin(angleDeg * rad), Math.cos(angleDeg * rad)];
  const [vx, vy] = [cosine * u + sine * v, cosine * v - sine * u];
  // Errors uniform to 0.1 m/s, standard deviation 0.058.
  const noise = () => 0.2 * (next() - 0.5);
  const azimuthDeg = Float64Array.from({ length: detections }, () => 120 * (next() - 0.5));
  const rangeRateMps = azimuthDeg.map(
    (a, i) => -(vx * Math.cos(a * rad) + vy * Math.sin(a * rad)) + noise() + (i % 5 === 0 ? 3 + 5 * next() : 0),
  );
  const rangeM = azimuthDeg.map(() => 5 + 60 * next());
  return { timeS, azimuthDeg, rangeRateMps, rangeM, yawRateDegps: (scale * yawRate) / rad, speedMps };
}

function drive(calibration, angleDeg, frames, options) {
  for (let index = 0; index < frames; index++) calibration.addFrame(frame(index, angleDeg, options));
  return calibration.estimate();
}

describe('a calibration', () => {
  for (const method of ['weighted-mean', 'kabsch', 'least-squares', 'orthogonal-distance']) {
    test(`finds a known angle by ${method}`, () => {
      const calibration = new Calibration({ ...radar, method, nominalDeg: 24 });
      const result = drive(calibration, 25, 400);
      // 400 frames of 32 standing points at 10 m/s: about 0.1 deg a frame, 0.005 deg in all.
      assert.ok(Math.abs(result.angleDeg - 25) < 0.1, `${result.angleDeg} +- ${result.sigmaDeg}`);
      assert.ok(result.sigmaDeg < 0.1, `${result.sigmaDeg}`);
      assert.ok(Math.abs(result.inlierShare - 0.8) < 0.1, `${result.inlierShare}`);
      assertShape(result, 'CalibrationResult');
      assertShape(result.frames, 'CalibrationCounts');
      const { given, ...rest } = result.frames;
      assert.equal(given, 400);
      assert.equal(
        Object.values(rest).reduce((a, b) => a + b),
        400,
      );
      assert.ok(rest.used > 350, `${rest.used}`);
      calibration.free();
      throwsTyped(() => calibration.estimate(), 'handle-freed', 'Calibration');
    });
  }

  test('takes the motion tracked over frames with every method, and no other with the recursive one', () => {
    for (const { name: method } of calibrationMethods()) {
      const calibration = new Calibration({ ...radar, method, motion: 'tracked', nominalDeg: 24 });
      const { angleDeg, sigmaDeg } = drive(calibration, 25, 400);
      assert.ok(Math.abs(angleDeg - 25) < Math.max(4 * sigmaDeg, 0.02), `${method} ${angleDeg} +- ${sigmaDeg}`);
      calibration.free();
    }
    throwsTyped(() => new Calibration({ ...radar, method: 'recursive', motion: 'ransac' }), 'incompatible', 'motion');
  });

  test('lists its methods, also in a worker', async () => {
    const methods = calibrationMethods();
    methods.forEach((method) => assertShape(method, 'CalibrationMethodInfo'));
    assert.ok(methods.length >= 4);
    methods.forEach(({ name }) => new Calibration({ ...radar, method: name }).free());
    const pool = createPool({ workers: 1 });
    assert.deepEqual(await pool.calibrationMethods(), methods);
    pool.terminate();
  });

  test('finds the scale of the yaw rate', () => {
    const calibration = new Calibration({ ...radar, nominalDeg: 25 });
    const { scale, scaleSigma } = drive(calibration, 25, 600, { scale: 1.05 });
    assert.ok(Math.abs(scale - 1.05) < 0.02, `${scale} +- ${scaleSigma}`);
    calibration.free();
  });

  test('tells a misaligned radar from an aligned one', () => {
    const misaligned = (angleDeg, options) => {
      const calibration = new Calibration({ ...radar, ...options });
      const result = drive(calibration, angleDeg, 400);
      calibration.free();
      result.warnings.forEach((warning) => assertShape(warning, 'Warning'));
      assert.equal(
        result.warnings.some(({ code }) => code === 'misaligned'),
        result.misaligned === true,
      );
      return result.misaligned;
    };
    assert.equal(misaligned(28, { nominalDeg: 25 }), true);
    assert.equal(misaligned(25.2, { nominalDeg: 25 }), false);
    assert.equal(misaligned(25, {}), null);
  });

  test('keeps what it knows in the same memory however long the drive, with the recursive method', async () => {
    const { memory } = await glue();
    const frames = Array.from({ length: 100 }, (_, index) => frame(index, 25));
    const grown = (method) => {
      const calibration = new Calibration({ ...radar, method, nominalDeg: 24 });
      const feed = (from, to) => {
        for (let k = from; k < to; k++) calibration.addFrame({ ...frames[k % 100], timeS: k * 0.06 });
      };
      feed(0, 200);
      const before = memory.buffer.byteLength;
      feed(200, 20_200);
      const bytes = memory.buffer.byteLength - before;
      calibration.free();
      return bytes;
    };
    assert.equal(grown('recursive'), 0);
    // The others keep 56 bytes of each frame, a megabyte here.
    assert.ok(grown('weighted-mean') > 0);
  });

  test('goes on from a snapshot to the last digit, also in a worker’s merge of drives', async () => {
    const options = { ...radar, method: 'recursive', nominalDeg: 24 };
    const whole = new Calibration(options);
    let cut = new Calibration(options);
    for (let index = 0; index < 300; index++) {
      if (index % 50 === 30) {
        const bytes = cut.snapshot();
        assert.ok(bytes.length < 16_384, `${bytes.length} bytes`);
        cut.free();
        cut = Calibration.restore(bytes);
      }
      assert.deepEqual(whole.addFrame(frame(index, 25)), cut.addFrame(frame(index, 25)));
    }
    const result = whole.estimate();
    assert.deepEqual(cut.estimate(), result);
    assert.ok(result.slipGradientSigmaDeg > 0 && result.delaySigmaS > 0 && result.speedScaleSigma > 0);
    const snapshots = [whole.snapshot(), cut.snapshot()];
    const merged = mergeCalibrations(snapshots);
    assertShape(merged, 'CalibrationResult');
    assert.equal(merged.frames.given, 600);
    // The same drive twice: the same angle, and known better.
    assert.ok(Math.abs(merged.angleDeg - result.angleDeg) < 0.02 && merged.sigmaDeg < result.sigmaDeg);
    const pool = createPool({ workers: 1 });
    assert.deepEqual(await pool.mergeCalibrations(snapshots), merged);
    pool.terminate();
    throwsTyped(() => Calibration.restore(Uint8Array.of(1, 2, 3)), 'malformed-snapshot', 'snapshot');
    throwsTyped(() => Calibration.restore('BSCA'), 'wrong-type', 'snapshot');
    throwsTyped(() => mergeCalibrations([]), 'empty', 'snapshots');
    throwsTyped(() => mergeCalibrations([new Uint8Array(9)]), 'malformed-snapshot', 'snapshot');
    const other = new Calibration({ ...radar, method: 'kabsch' });
    throwsTyped(() => other.snapshot(), 'incompatible', 'method');
    for (const calibration of [whole, cut, other]) calibration.free();
  });

  test('starts a session where the clock was reset, and says so', () => {
    const calibration = new Calibration({ ...radar, method: 'recursive', nominalDeg: 25 });
    const before = drive(calibration, 25, 400);
    assert.deepEqual(
      [before.clockResets, before.rejectedFrames, before.stale, before.lastFrameS],
      [0, 0, false, 399 * 0.06],
    );
    let rejected = 0;
    for (let index = 0; index < 200; index++) {
      try {
        calibration.addFrame(frame(index, 25));
      } catch (error) {
        assert.equal(error.code, 'time-backwards');
        rejected += 1;
        const { stale, warnings } = calibration.estimate();
        assert.equal(stale, rejected >= 5);
        assert.equal(
          warnings.some(({ code }) => code === 'stale'),
          stale,
        );
      }
    }
    const after = calibration.estimate();
    assert.deepEqual([rejected, after.rejectedFrames, after.clockResets, after.stale], [9, 9, 1, false]);
    assert.equal(after.frames.given, 400 + 191);
    assert.equal(after.lastFrameS, 199 * 0.06);
    assert.ok(after.warnings.some(({ code }) => code === 'clock-reset'));
    assert.equal(after.alignment, 'aligned');
    calibration.restart();
    const restarted = calibration.estimate();
    assert.ok(Math.abs(restarted.angleDeg - after.angleDeg) < 1e-6);
    assert.equal(restarted.lastFrameS, undefined);
    calibration.addFrame({ ...frame(0, 25), timeS: -1e6 });
    assert.equal(calibration.estimate().clockResets, 1);
    const later = calibration.snapshot();
    later[4] += 1;
    throwsTyped(() => Calibration.restore(later), 'unsupported-snapshot', 'snapshot');
    calibration.free();
  });

  test('leaves out special values of azimuths and range rates, and counts them', () => {
    for (const method of ['recursive', 'least-squares']) {
      const options = { ...radar, method, nominalDeg: 22 };
      const [clean, calibration] = [new Calibration(options), new Calibration(options)];
      const special = [
        [655.35, 0],
        [10, 327.67],
      ];
      for (let index = 0; index < 400; index++) {
        const good = frame(index, 25);
        const more = (column, place) => Float64Array.from([...special.map((pair) => pair[place]), ...column]);
        const bad = {
          ...good,
          azimuthDeg: more(good.azimuthDeg, 0),
          rangeRateMps: more(good.rangeRateMps, 1),
          rangeM: null,
        };
        const { weights } = calibration.addFrame(bad);
        assert.equal(weights.length, 42);
        assert.deepEqual([...weights.subarray(0, 2)], [0, 0]);
        clean.addFrame({ ...good, rangeM: null });
      }
      const { rejectedDetections, warnings, ...found } = calibration.estimate();
      const { rejectedDetections: none, warnings: usual, ...expected } = clean.estimate();
      assert.deepEqual([rejectedDetections, none], [800, 0]);
      assert.deepEqual(found, expected);
      assert.equal(found.alignment, 'misaligned');
      assert.deepEqual(
        warnings.filter(({ code }) => code !== 'invalid-detections'),
        usual,
      );
      assert.equal(warnings.length, usual.length + 1);
      for (const each of [clean, calibration]) each.free();
    }
  });

  test('says what became of each frame', () => {
    const calibration = new Calibration({ ...radar, nominalDeg: 25 });
    const good = frame(0, 25);
    const used = calibration.addFrame(good);
    assertShape(used, 'FrameOutcome');
    assertShape(used.motion, 'RadarMotion');
    assert.equal(used.verdict, 'used');
    assert.equal(used.weights.length, 40);
    assert.ok(Math.abs(Math.hypot(...used.motion.velocityMps) - 10) < 0.5, `${used.motion.velocityMps}`);
    const none = new Float32Array(0);
    assert.equal(
      calibration.addFrame({ timeS: 1, azimuthDeg: none, rangeRateMps: none, yawRateDegps: 0 }).verdict,
      'sparse',
    );
    assert.equal(calibration.addFrame({ ...good, timeS: 2, yawRateDegps: null }).verdict, 'without-motion');
    assert.equal(calibration.addFrame({ ...good, timeS: 3, yawRateDegps: 300 }).verdict, 'turning');
    assert.equal(calibration.estimate().frames.given, 4);
    calibration.free();
  });

  test('without frames knows nothing, and says so', () => {
    const calibration = new Calibration(radar);
    const result = calibration.estimate();
    assert.equal(result.sigmaDeg, Infinity);
    assert.equal(result.converged, false);
    assert.ok(
      result.warnings.some(({ code }) => code === 'no-frames'),
      JSON.stringify(result.warnings),
    );
    calibration.free();
  });
});

describe('bad input', () => {
  test('of options is refused by name', () => {
    const bad = (options, code, what) => throwsTyped(() => new Calibration(options), code, what);
    bad({}, 'missing', 'method');
    bad({ method: 'kabsch' }, 'missing', 'xM');
    bad({ ...radar, alarmDeg: 0 }, 'out-of-range', 'alarmDeg');
    bad({ ...radar, nominalDeg: 200 }, 'out-of-range', 'nominalDeg');
    bad(undefined, 'wrong-type', 'options');
    bad({ ...radar, method: 'magic' }, 'unknown-name', 'method');
    bad({ ...radar, motion: 'magic' }, 'unknown-name', 'motion');
    bad({ ...radar, x: 1 }, 'unknown-option', 'x');
    bad({ ...radar, xM: Number.NaN }, 'out-of-range', 'xM');
    for (const option of ['rangeRateSigmaMps', 'azimuthSigmaDeg', 'inlierResidualMps'])
      bad({ ...radar, [option]: -1 }, 'out-of-range', option);
    bad({ ...radar, confidence: 2 }, 'out-of-range');
  });

  test('of a frame is refused by name, and the instance goes on', () => {
    const calibration = new Calibration({ ...radar, nominalDeg: 25 });
    const untouched = new Calibration({ ...radar, nominalDeg: 25 });
    for (let index = 0; index < 200; index++) {
      const good = frame(index, 25);
      if (index % 20 === 1) {
        const bad = (change, code, what) => throwsTyped(() => calibration.addFrame({ ...good, ...change }), code, what);
        bad({ timeS: undefined }, 'missing', 'frame.timeS');
        bad({ timeS: good.timeS - 1 }, 'time-backwards');
        bad({ timeS: Infinity }, 'out-of-range', 'frame.timeS');
        bad({ yawRateDegps: undefined }, 'missing', 'frame.yawRateDegps');
        bad({ yawRateDegps: 'fast' }, 'wrong-type', 'frame.yawRateDegps');
        bad({ azimuthDeg: [1, 2] }, 'wrong-type', 'frame.azimuthDeg');
        bad({ rangeRateMps: new Float64Array(39) }, 'shape', 'frame.rangeRateMps');
        bad({ rangeM: new Float32Array(41) }, 'shape', 'frame.rangeM');
        bad({ azimuthDeg: new Float64Array(40).fill(Number.NaN) }, 'not-finite', 'frame.azimuthDeg');
        bad({ rangeRateMps: new Float64Array(40).fill(Infinity) }, 'not-finite', 'frame.rangeRateMps');
        bad({ detections: 3 }, 'unknown-option', 'frame.detections');
        throwsTyped(() => calibration.addFrame(null), 'wrong-type', 'frame');
      }
      assert.deepEqual(calibration.addFrame(good), untouched.addFrame(good));
    }
    // Frames rejected for their time are counted, and change nothing else.
    const { rejectedFrames, ...found } = calibration.estimate();
    const { rejectedFrames: none, ...expected } = untouched.estimate();
    assert.deepEqual([found, none], [expected, 0]);
    assert.ok(rejectedFrames > 0);
    calibration.free();
    untouched.free();
  });
});
