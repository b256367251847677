import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { Capture, estimate, init, processCube, simulateCube } from 'boresight';
import { createPool } from 'boresight/worker';
import { rejectsTyped, throwsTyped } from './lib/assert.mjs';
import { assertTargets, bin, cfg } from './lib/recording.mjs';

before(() => init());

describe('a recorded capture', () => {
  let capture;
  before(() => {
    capture = new Capture(bin, cfg);
  });
  after(() => capture.free());

  test('says what it is', () => {
    const { info } = capture;
    assert.equal(info.frames, 8);
    assert.equal(info.trailingBytes, 0);
    assert.equal(info.config.array, 'awr1642');
    assert.equal(info.array.positions.length, 8);
    assert.deepEqual(info.warnings, []);
  });

  test('has both targets in every frame', () => {
    for (let frame = 0; frame < 8; frame++) {
      const result = capture.processFrame(frame);
      assertTargets(result.detections);
      assert.equal(result.frame, frame);
      assert.ok(result.detections.every((d) => d.frame === frame));
      const [ranges, rates] = result.shape;
      assert.deepEqual(
        [result.rangeM.length, result.rateMps.length, result.rangeProfileDb.length],
        [ranges, rates, ranges],
      );
      assert.equal(result.rangeDopplerDb.length, ranges * rates);
    }
  });

  test('has both targets in all frames together, by several methods', () => {
    for (const method of ['bartlett', 'capon', 'music', 'iaa']) {
      const result = capture.combineFrames({ angle: { method, sources: 1 } });
      assertTargets(result.detections);
      assert.equal(result.frames, 8);
    }
  });

  test('shows how far it is and can be stopped', () => {
    const steps = [];
    capture.combineFrames({ firstFrame: 2, frameCount: 4 }, (...step) => void steps.push(step));
    assert.deepEqual(steps.at(-1), [8, 8]);
    throwsTyped(() => capture.combineFrames({}, (done) => done < 2), 'cancelled', 'steps');
    throwsTyped(
      () =>
        capture.combineFrames({}, () => {
          throw new Error('mine');
        }),
      'cancelled',
      'steps',
    );
    assertTargets(capture.combineFrames().detections);
  });

  test('refuses calls from inside its own callback', () => {
    const nested = [];
    capture.combineFrames({}, () => {
      try {
        capture.processFrame(0);
      } catch (error) {
        nested.push(error.code);
      }
    });
    assert.ok(nested.length > 0 && nested.every((code) => code === 'handle-busy'), `${nested}`);
  });

  test('gives snapshots and spectrum of a cell', () => {
    const cell = { rangeBin: 58, dopplerBin: 8 };
    const spectrum = capture.cellSpectrum(cell, { method: 'capon' });
    assert.ok(Math.abs(spectrum.sources[0].azimuthDeg + 10.8) <= 1, `${spectrum.sources[0].azimuthDeg}`);
    assert.ok(spectrum.spectrum.valuesDb.every(Number.isFinite));
    const snapshots = capture.cellSnapshots(cell);
    assert.deepEqual(snapshots.shape, [8, 8]);
    const music = estimate({ snapshots }, { method: 'root-music', array: 'awr1642', sources: 1 });
    assert.ok(Math.abs(music.sources[0].azimuthDeg + 10.8) <= 1, `${music.sources[0].azimuthDeg}`);
    assert.deepEqual(capture.cellSnapshots({ ...cell, frame: 3 }).shape, [8, 1]);
  });

  test('obeys the options of the chain', () => {
    const all = capture.processFrame(0);
    const near = capture.processFrame(0, { region: { rangeM: [2, 4] } });
    assert.ok(near.detections.length > 0 && near.detections.every((d) => d.rangeM >= 2 && d.rangeM <= 4));
    assert.ok(near.counts.outsideRegion > 0);
    assert.equal(capture.processFrame(0, { maxDetections: 1 }).detections.length, 1);
    assert.deepEqual(capture.processFrame(0, { rangePadding: 2 }).shape, [2 * all.shape[0], all.shape[1]]);
    const over = (cfar) => capture.processFrame(0, { cfar }).counts.cellsOverThreshold;
    for (const kind of ['excision', 'cell-averaging', 'greatest-of', 'smallest-of', 'ordered-statistic']) {
      assert.ok(over({ kind, falseAlarm: 1e-9 }) < over({ kind, falseAlarm: 1e-2 }), kind);
    }
    const ordered = { kind: 'ordered-statistic', axes: 'both' };
    assert.ok(over({ ...ordered, rank: 0.5 }) !== over({ ...ordered, rank: 0.9 }));
    const windowed = capture.processFrame(0, { rangeWindow: 'chebyshev', dopplerWindow: 'taylor' });
    assert.notDeepEqual(windowed.rangeDopplerDb, all.rangeDopplerDb);
    assert.ok(windowed.detections.some((d) => Math.abs(d.rangeM - 2.95) < 0.05));
  });

  test('says why a cell is a detection or none', () => {
    const { detections } = capture.processFrame(0);
    const [first] = detections;
    const cell = { rangeBin: first.rangeBin, dopplerBin: first.dopplerBin, frame: 0 };
    const told = capture.explainCell(cell);
    assert.equal(told.verdict, 'kept');
    assert.equal(told.thresholdDb, told.profileThresholdDb[cell.rangeBin]);
    assert.ok(told.powerDb > told.thresholdDb && told.thresholdDb > told.noiseDb);
    const beside = capture.explainCell({ ...cell, rangeBin: cell.rangeBin + 1 });
    assert.equal(beside.verdict, 'grouped');
    assert.deepEqual([beside.peakRangeBin, beside.peakDopplerBin], [cell.rangeBin, cell.dopplerBin]);
    const limited = capture.explainCell(cell, { region: { rangeM: [first.rangeM + 1, 100] } });
    assert.equal(limited.verdict, 'outside-range');
    const { frame: _, ...together } = cell;
    assert.equal(capture.explainCell(together).verdict, 'kept');
    throwsTyped(() => capture.explainCell({ rangeBin: 256, dopplerBin: 0 }), 'out-of-range', 'range bin');
  });

  test('refuses bad options by name and goes on', () => {
    const bad = (options, code, what) => throwsTyped(() => capture.processFrame(0, options), code, what);
    bad({ rangeWindow: 'hanning' }, 'unknown-name', 'rangeWindow');
    // Before a grid is made of so many points.
    bad({ angle: { gridPoints: 1e8 } }, 'out-of-range', 'angle.gridPoints');
    bad({ rangePadding: 0 }, 'out-of-range');
    bad({ rangePadding: 1e6 }, 'out-of-range', 'rangePadding');
    bad({ cfar: { kind: 'median' } }, 'unknown-name', 'cfar.kind');
    bad({ cfar: { falseAlarm: 2 } }, 'out-of-range');
    bad({ cfar: { guardCells: [1] } }, 'shape', 'cfar.guardCells');
    bad({ cfar: { trainingCells: [1e9, 1] } }, 'out-of-range');
    bad({ cfar: { axes: 'doppler', trainingCells: [1, 500] } }, 'cfar-window');
    bad({ region: { rangeM: [4, 2] } }, 'out-of-range', 'region.rangeM');
    bad({ region: { azimuthDeg: [-100, 0] } }, 'out-of-range', 'region.azimuthDeg[0]');
    bad({ angle: { method: 'musik' } }, 'unknown-name', 'angle.method');
    bad({ angle: { array: 'ula8' } }, 'unknown-option', 'angle.array');
    bad({ angle: { method: 'music' } }, 'snapshot-count');
    bad({ array: 'ula9' }, 'channels', 'array');
    bad({ maxDetections: 0 }, 'out-of-range', 'maxDetections');
    bad({ windows: 'hann' }, 'unknown-option', 'windows');
    bad(null, 'wrong-type', 'options');
    for (const frame of [8, -1, 0.5, Number.NaN, 4e9])
      throwsTyped(() => capture.processFrame(frame), 'out-of-range', 'frame');
    throwsTyped(() => capture.processFrame('0'), 'wrong-type', 'frame');
    throwsTyped(() => capture.combineFrames({ firstFrame: 8 }), 'out-of-range', 'firstFrame');
    throwsTyped(() => capture.combineFrames({ frameCount: 9 }), 'out-of-range', 'frameCount');
    throwsTyped(() => capture.cellSpectrum({ rangeBin: 256, dopplerBin: 0 }), 'out-of-range');
    throwsTyped(() => capture.cellSpectrum({ rangeBin: 58 }), 'missing', 'cell.dopplerBin');
    assertTargets(capture.processFrame(0).detections);
  });
});

describe('a capture that does not match its configuration', () => {
  test('is refused, or remarked on where frames are whole', () => {
    throwsTyped(() => new Capture(new Uint8Array(0), cfg), 'capture-too-short', 'capture');
    throwsTyped(() => new Capture(bin.subarray(0, 131_071), cfg), 'capture-too-short', 'capture');
    throwsTyped(() => new Capture(bin, ''), 'config-incomplete');
    throwsTyped(() => new Capture(cfg.toString(), cfg), 'wrong-type', 'capture');
    const twice = cfg.toString().replace('frameCfg 0 1 16', 'frameCfg 0 1 160');
    throwsTyped(() => new Capture(bin.subarray(0, 131_072 * 5), twice), 'capture-too-short');
    const cut = new Capture(bin.subarray(0, 300_000), cfg);
    assert.equal(cut.info.frames, 2);
    assert.equal(cut.info.trailingBytes, 300_000 - 2 * 131_072);
    assert.equal(cut.info.warnings[0].code, 'trailing-bytes');
    cut.free();
  });

  test('of an unknown platform needs an array', () => {
    const capture = new Capture(bin, cfg.toString().replaceAll('xWR16xx', 'xWR99xx'));
    assert.equal(capture.info.array, null);
    throwsTyped(() => capture.processFrame(0), 'missing', 'array');
    assertTargets(capture.processFrame(0, { array: 'awr1642' }).detections);
    capture.free();
    throwsTyped(() => capture.processFrame(0), 'handle-freed', 'Capture');
  });
});

describe('a pool with a capture', () => {
  let pool;
  before(() => {
    pool = createPool({ workers: 2 });
  });
  after(() => pool.terminate());

  test('processes every frame, in order and with its number', async () => {
    const progress = [];
    const results = await pool.processFrames(bin, cfg, {}, { onProgress: (...step) => progress.push(step) });
    assert.deepEqual(
      results.map(({ frame }) => frame),
      [0, 1, 2, 3, 4, 5, 6, 7],
    );
    assert.deepEqual(progress.at(-1), [8, 8]);
    const capture = new Capture(bin, cfg);
    results.forEach((result, frame) => assert.deepEqual(result, capture.processFrame(frame)));
    capture.free();
  });

  test('gives what the handle gives', async () => {
    const capture = new Capture(bin, cfg);
    const cell = { rangeBin: 58, dopplerBin: 8 };
    const steps = [];
    const [info, frame, combined, snapshots, spectrum] = await Promise.all([
      pool.captureInfo(bin, cfg),
      pool.processFrame(bin, cfg, 3),
      pool.combineFrames(bin, cfg, {}, { onProgress: (...step) => steps.push(step) }),
      pool.cellSnapshots(bin, cfg, cell),
      pool.cellSpectrum(bin, cfg, cell, { method: 'iaa' }),
    ]);
    assert.deepEqual(info, capture.info);
    assert.deepEqual(frame, capture.processFrame(3));
    assert.deepEqual(combined, capture.combineFrames());
    assert.deepEqual(snapshots, capture.cellSnapshots(cell));
    assert.deepEqual(spectrum, capture.cellSpectrum(cell, { method: 'iaa' }));
    assert.deepEqual(steps.at(-1), [16, 16]);
    assert.equal(steps.length, 17);
    capture.free();
  });

  test('rejects with the errors of the handle', async () => {
    await rejectsTyped(pool.processFrames(bin.subarray(0, 100), cfg), 'capture-too-short', 'capture');
    await rejectsTyped(pool.processFrames(bin, 'nothing'), 'config-incomplete');
    await rejectsTyped(pool.processFrame(bin, cfg, 8), 'out-of-range', 'frame');
  });
});

describe('a simulated cube', () => {
  const waveform = () => {
    const capture = new Capture(bin, cfg);
    const { waveform } = capture.info.config;
    capture.free();
    return waveform;
  };

  test('through the chain gives its targets back', () => {
    const options = { waveform: waveform(), array: 'awr1642' };
    const target = { rangeM: 6, rateMps: 1.2, azimuthDeg: 20, powerDb: -10 };
    const cube = simulateCube({ ...options, targets: [target], snrDb: 20, frames: 2, seed: 1 });
    assert.deepEqual(cube.shape, [2, 16, 2, 4, 256]);
    const results = processCube(cube, options);
    assert.equal(results.length, 2);
    for (const { detections } of results) {
      const [strongest] = detections;
      assert.ok(Math.abs(strongest.rangeM - 6) < 0.05, `${strongest.rangeM}`);
      assert.ok(Math.abs(strongest.rateMps - 1.2) < 0.1, `${strongest.rateMps}`);
      assert.ok(Math.abs(strongest.azimuthDeg - 20) < 1, `${strongest.azimuthDeg}`);
      assert.ok(Math.abs(strongest.powerDb + 10) < 1.5, `${strongest.powerDb}`);
    }
    throwsTyped(() => processCube(cube, { array: 'awr1642' }), 'missing', 'waveform');
    throwsTyped(() => processCube(cube, { waveform: options.waveform }), 'missing', 'array');
    throwsTyped(() => processCube({ data: cube.data, shape: [cube.data.length / 2] }, options), 'shape', 'cube');
    cube.data[5] = Number.NaN;
    throwsTyped(() => processCube(cube, options), 'not-finite');
  });

  test('may fluctuate, be noisy, be reflected by the road and be interfered with', () => {
    const options = { waveform: waveform(), array: 'awr1642', frames: 2, snrDb: 60, seed: 1 };
    const cube = (more) => simulateCube({ ...options, targets: [{ rangeM: 6, powerDb: -10 }], ...more }).data;
    const plain = cube({});
    const power = (data) => data.reduce((sum, value) => sum + value * value, 0) / plain.length;
    for (const more of [
      { fluctuation: 'swerling1' },
      { fluctuation: 'swerling4' },
      { phaseNoiseDb: -70 },
      { ground: { radarHeightM: 0.5, reflection: 0.7 } },
    ]) {
      const changed = cube(more);
      assert.deepEqual(changed, cube(more), 'the same seed gives the same samples');
      const ratio = power(changed.map((value, k) => value - plain[k])) / power(plain);
      assert.ok(ratio > 1e-4 && ratio < 20, `${JSON.stringify(more)}: ${ratio}`);
    }
    const interferer = {
      azimuthDeg: -20,
      powerDb: 30,
      startFrequencyHz: 78e9,
      slopeHzPerS: -40e12,
      rampS: 50e-6,
      intervalS: 55e-6,
    };
    const hit = cube({ interferers: [interferer] }).filter((value) => Math.abs(value) > 5).length;
    assert.ok(hit > 20 && hit < plain.length / 4, `${hit} parts of samples are hit`);
    const refused = (more, code, what) => throwsTyped(() => cube(more), code, what);
    refused({ fluctuation: 'swerling5' }, 'unknown-name', 'fluctuation');
    refused({ ground: { reflection: 2 } }, 'out-of-range', 'ground.reflection');
    refused({ ground: {}, nearField: true }, 'incompatible', 'ground');
    refused({ interferers: [{ ...interferer, rampS: 0 }] }, 'out-of-range', 'interferers[0].rampS');
  });

  test('of transmitters that send at once gives its targets back, over the whole chirp rate in Doppler division', () => {
    for (const [multiplexing, loops, shape] of [
      ['binary-phase', 16, [1, 16, 2, 4, 256]],
      ['doppler-division', 48, [1, 48, 1, 4, 256]],
    ]) {
      const options = { waveform: { ...waveform(), multiplexing, loops }, array: 'awr1642' };
      const rateMps = multiplexing === 'binary-phase' ? 3.1 : 8.2;
      const target = { rangeM: 6, rateMps, azimuthDeg: 20, powerDb: -10 };
      const cube = simulateCube({ ...options, targets: [target], snrDb: 10, seed: 1 });
      assert.deepEqual(cube.shape, shape);
      const [{ detections, counts, unambiguousRateMps }] = processCube(cube, options);
      assert.equal(detections.length, 1, multiplexing);
      assert.ok(unambiguousRateMps > rateMps);
      assert.ok(Math.abs(detections[0].rateMps - rateMps) < 0.1, `${detections[0].rateMps}`);
      assert.ok(Math.abs(detections[0].azimuthDeg - 20) < 1, `${detections[0].azimuthDeg}`);
      assert.equal(counts.otherBands > 0, multiplexing === 'doppler-division');
    }
  });

  test('of a target beyond the unambiguous rate tells its fold where asked', () => {
    const options = { waveform: waveform(), array: 'awr1642' };
    const target = { rangeM: 6, rateMps: 7.5, azimuthDeg: 20, powerDb: -10 };
    const cube = simulateCube({ ...options, targets: [target], snrDb: 10, seed: 1 });
    const [{ detections: folded }] = processCube(cube, options);
    assert.ok(folded[0].rateMps < 0 && folded[0].dopplerFold === 0 && !('foldProbability' in folded[0]));
    const [{ detections, unambiguousRateMps }] = processCube(cube, { ...options, dopplerFolds: 1 });
    assert.ok(Math.abs(detections[0].rateMps - 7.5) < 0.1 && unambiguousRateMps > 9);
    assert.ok(detections[0].dopplerFold === 1 && detections[0].foldProbability > 0.99);
    assert.ok(Math.abs(detections[0].azimuthDeg - 20) < 1, `${detections[0].azimuthDeg}`);
    throwsTyped(() => processCube(cube, { ...options, dopplerFolds: 33 }), 'out-of-range', 'dopplerFolds');
  });
});
