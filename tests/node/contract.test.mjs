// What the functions return has exactly the fields that the types declare.
import assert from 'node:assert/strict';
import { before, test } from 'node:test';
import * as boresight from 'boresight';
import * as workers from 'boresight/worker';
import { batchOf, planeWaves } from './lib/assert.mjs';
import { live } from './lib/calls.mjs';
import { assertShape, schemas } from './lib/interfaces.mjs';
import { bin, cfg, dat } from './lib/recording.mjs';

before(() => boresight.init());

test('arrays and methods', () => {
  const array = boresight.array('awr1642');
  assertShape(array, 'ArrayGeometry');
  assert.deepEqual(Object.keys(array.channels[0]), ['tx', 'rx']);
  for (const method of boresight.methods()) assertShape(method, 'MethodInfo');
});

test('estimates', () => {
  const input = { snapshots: planeWaves(8, 20, [10]) };
  const estimate = boresight.estimate(input, { method: 'music', array: 'ula8', sources: 1 });
  assertShape(estimate, 'Estimate');
  assertShape(estimate.spectrum, 'Spectrum');
  estimate.sources.forEach((source) => assertShape(source, 'Source'));
  // The covariance of one snapshot is singular.
  const { warnings } = boresight.estimate({ snapshots: planeWaves(8, 1, [10]) }, { method: 'capon', array: 'ula8' });
  assert.ok(warnings.length > 0);
  warnings.forEach((warning) => assertShape(warning, 'Warning'));
  assertShape(boresight.countSources(input), 'CountResult');
  const bound = { targets: [{ azimuthDeg: 3, snrDb: 10 }], snapshots: 2 };
  for (const array of ['ula8', 'awr1843']) assertShape(boresight.cramerRaoBound({ ...bound, array }), 'Bound');
});

test('batches', () => {
  const cells = batchOf([[10], [], [-20, 5]].map((angles) => planeWaves(8, 1, angles)));
  const estimator = new boresight.Estimator({ method: 'capon', array: 'ula8' });
  const batch = estimator.estimateBatch({ snapshots: cells }, { spectra: true });
  estimator.free();
  assertShape(batch, 'BatchEstimate');
  assertShape(batch.spectra, 'BatchSpectra');
  assert.ok(batch.warnings.length > 0);
  batch.warnings.forEach((warning) => assertShape(warning, 'BatchWarning'));
});

test('simulations', () => {
  const snapshots = boresight.simulateSnapshots({ array: 'ula4', targets: { count: [1, 1] }, snrDb: 10, seed: 1 });
  assertShape(snapshots, 'SnapshotResult');
  snapshots.truth.flat().forEach((target) => assertShape(target, 'TrueTarget'));
  const { waveform } = boresight.parseConfig(cfg);
  assertShape(boresight.simulateCube({ waveform, array: 'awr1642', targets: [], snrDb: 0, seed: 1 }), 'CubeResult');
});

test('images', () => {
  const scene = boresight.streetScene();
  assertShape(scene, 'StreetScene');
  scene.radars.forEach((radar) => assertShape(radar, 'StreetRadar'));
  scene.targets.forEach((target) => assertShape(target, 'StreetTarget'));
  scene.outlines.forEach((outline) => assertShape(outline, 'StreetOutline'));
  const capture = new boresight.Capture(bin, cfg);
  const { waveform } = capture.info.config;
  const cells = capture.frameCells(0);
  capture.free();
  assertShape(cells, 'FrameCells');
  assertShape(cells.counts, 'FrameCounts');
  const street = boresight.simulateStreet({ radar: 'left' });
  assertShape(street, 'SimulatedStreet');
  assertShape(street.cube, 'CubeResult');
  street.targets.forEach((target) => assertShape(target, 'VisibleTarget'));
  const {
    radar: { array, mounting },
  } = street;
  assertShape(boresight.imagePlan({ waveform, array: 'awr1642' }), 'ImagePlan');
  const frame = boresight.imageFrame(street.cube, { waveform: street.radar.waveform, array });
  assertShape(frame, 'ImageFrame');
  assertShape(frame.map, 'RangeAzimuthMap');
  const grid = { xM: [0, 20], yM: [-10, 10], cellM: 0.5 };
  const view = boresight.birdsEyeView({ radars: [{ map: frame.map, mounting }], grid });
  assertShape(view, 'BirdsEyeView');
  view.mountings.forEach((mounting) => assertShape(mounting, 'Mounting'));
  assertShape(boresight.sidelobeMeasure(view, scene.targets, { gateM: 1 }), 'SidelobeMeasure');
});

test('captures', () => {
  const capture = new boresight.Capture(bin, cfg);
  assertShape(capture.info, 'CaptureInfo');
  assertShape(capture.info.config, 'RadarConfig');
  assertShape(capture.info.config.waveform, 'Waveform');
  assertShape(capture.info.config.summary, 'WaveformSummary');
  const frame = capture.processFrame(0);
  assertShape(frame, 'FrameResult');
  assertShape(frame.counts, 'FrameCounts');
  frame.detections.forEach((detection) => assertShape(detection, 'Detection'));
  assert.deepEqual(
    boresight.readDetectionsCsv(boresight.writeDetectionsCsv(frame.detections)).map(Object.keys),
    frame.detections.map(Object.keys),
  );
  assertShape(capture.cellSnapshots({ rangeBin: 58, dopplerBin: 8 }), 'ComplexData');
  assertShape(capture.explainCell({ rangeBin: 58, dopplerBin: 8 }), 'CellExplanation');
  capture.free();
});

test('files', () => {
  const log = boresight.parseBoardLog(dat, cfg);
  assertShape(log, 'BoardLog');
  log.frames.slice(0, 3).forEach((frame) => {
    assertShape(frame, 'BoardFrame');
    frame.objects.forEach((object) => assertShape(object, 'BoardObject'));
  });
  const stream = new boresight.BoardLogStream();
  assertShape(stream.counts(), 'BoardLogCounts');
  stream.free();
  const array = { kind: 'real', data: new Float32Array(2), shape: [2] };
  assertShape(boresight.readNpy(boresight.writeNpy(array)), 'NpyArray');
});

test('the numbers of verdicts are their places in the type', () => {
  assert.deepEqual(
    boresight.frameVerdicts,
    schemas.FrameVerdict.oneOf.map((verdict) => verdict.const),
  );
});

test('the pool has every plain function of the package', () => {
  const plain = Object.entries(boresight)
    .filter(([, value]) => typeof value === 'function' && !/^class /.test(Function.prototype.toString.call(value)))
    .map(([name]) => name)
    // Limits are those of a thread; a pool has an option for them. Ports are the page's, and none goes to a worker.
    .filter((name) => !name.startsWith('init') && name !== 'setLimits' && !live.includes(name));
  assert.ok(plain.length > 15);
  for (const name of plain) assert.equal(typeof workers.Pool.prototype[name], 'function', name);
});
