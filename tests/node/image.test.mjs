// Images: from cubes of the simulated street and frames of the capture to bird's-eye views.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import {
  birdsEyeView,
  Capture,
  Estimator,
  frameCells,
  imageFrame,
  init,
  rangeAzimuthMap,
  sidelobeMeasure,
  simulateStreet,
  streetScene,
} from 'boresight';
import { createPool } from 'boresight/worker';
import { throwsTyped } from './lib/assert.mjs';
import { bin, cfg } from './lib/recording.mjs';

let scene;
let street;
let options;
let pool;
before(async () => {
  await init();
  scene = streetScene({ seed: 1 });
  street = simulateStreet({ seed: 1, radar: 'front-left' });
  options = { waveform: street.radar.waveform, array: street.radar.array, cfar: { kind: 'cell-averaging' } };
  pool = createPool({ workers: 2 });
});
after(() => pool.terminate());

const by = (method, more) => ({ ...options, angle: { method }, ...more });
const viewOf = (map, mounting) =>
  birdsEyeView({
    radars: [{ map, mounting }],
    grid: { xM: [-10, 60], yM: [-20, 30], cellM: 0.25 },
  });
const gate = { rangeM: 0.8, sine: 0.025 };

test('the street has five radars, and what each sees lies in the scene', () => {
  assert.deepEqual(
    scene.radars.map(({ name }) => name),
    ['right', 'front-right', 'front-left', 'left', 'rear'],
  );
  assert.ok(scene.targets.length > 500);
  const { xM, yM, yawDeg } = street.radar.mounting;
  for (const { target, rangeM, azimuthDeg, rateMps } of street.targets) {
    const angle = ((yawDeg + azimuthDeg) * Math.PI) / 180;
    const point = scene.targets[target];
    assert.ok(Math.hypot(xM + rangeM * Math.cos(angle) - point.xM, yM + rangeM * Math.sin(angle) - point.yM) < 1e-6);
    const rate = (point.vxMps - scene.egoSpeedMps) * Math.cos(angle) + point.vyMps * Math.sin(angle);
    assert.ok(Math.abs(rate - rateMps) < 1e-9);
  }
  for (const { kind, outline } of scene.targets) assert.equal(scene.outlines[outline].kind, kind);
  assert.deepEqual(street.cube.shape, [1, 128, 6, 8, 256]);
});

test('a frame has about 300 cells, and their snapshots give what the chain gives', () => {
  const cells = frameCells(street.cube, { ...options, peakGrouping: false, maxDetections: 4096 });
  const count = cells.rangeM.length;
  assert.ok(count > 200 && count < 500, String(count));
  assert.deepEqual(cells.snapshots.shape, [count, 48]);
  assert.equal(cells.counts.cellsOverThreshold, count + cells.counts.outsideRegion + cells.counts.outsideUsableRange);
  for (const key of ['rateMps', 'powerDb', 'snrDb', 'rangeBin', 'dopplerBin']) assert.equal(cells[key].length, count);
  // Power of the snapshot is that of the cell, but for interpolation between bins (at most 1.5 dB each way of two).
  const peaks = frameCells(street.cube, options);
  peaks.powerDb.forEach((powerDb, k) => {
    const snapshot = peaks.snapshots.data.subarray(k * 96, (k + 1) * 96);
    const mean = snapshot.reduce((sum, x) => sum + x * x, 0) / 48;
    assert.ok(Math.abs(10 * Math.log10(mean) - powerDb) < 3);
  });
});

test('the image of IAA is cleaner than that of the FFT, and shows the targets no less', () => {
  const targets = street.targets.map(({ target }) => scene.targets[target]);
  const measured = Object.fromEntries(
    ['bartlett', 'iaa', 'nomp'].map((method) => {
      const { map } = imageFrame(street.cube, by(method));
      return [method, sidelobeMeasure(viewOf(map, street.radar.mounting), targets, gate)];
    }),
  );
  assert.ok(measured.bartlett.outsideDb > -9, JSON.stringify(measured));
  assert.ok(measured.iaa.outsideDb < measured.bartlett.outsideDb - 10, JSON.stringify(measured));
  assert.ok(measured.iaa.litOutside < 0.1 * measured.bartlett.litOutside);
  // The FFT's smear lights the gates of targets that it does not show; what is left must be nearly all the same.
  assert.ok(measured.iaa.litTargets > 0.75 * measured.bartlett.litTargets, JSON.stringify(measured));
});

test('maps hold all power of the estimates, on the grid or beside it', () => {
  const cells = frameCells(street.cube, { ...options, maxDetections: 40 });
  const estimator = new Estimator({ method: 'iaa', array: options.array });
  const estimates = estimator.estimateBatch({ snapshots: cells.snapshots });
  estimator.free();
  const grid = { rangeM: [0, 30], ranges: 76, fieldOfViewDeg: 45, azimuths: 128 };
  const map = rangeAzimuthMap({ cells, estimates, from: 'targets', grid });
  assert.deepEqual(map.shape, [76, 128]);
  assert.ok(map.outside.count > 0);
  const all = estimates.powerDb.reduce((sum, db) => sum + 10 ** (db / 10), 0);
  const found = map.power.reduce((sum, power) => sum + power, map.outside.power);
  assert.ok(Math.abs(found / all - 1) < 1e-5);
  const half = rangeAzimuthMap({
    cells,
    from: 'targets',
    grid,
    estimates: { ...estimates, confidence: new Float64Array(estimates.cell.length).fill(0.5) },
  });
  assert.ok(Math.abs(half.power.reduce((sum, power) => sum + power, half.outside.power) / all - 0.5) < 1e-5);
});

test('radars are fused by maximum, with the radar each cell came from', () => {
  const { map } = imageFrame(street.cube, by('bartlett'));
  const other = { xM: 3.86, yM: -0.7, yawDeg: -25 };
  const grid = { xM: [0, 40], yM: [-20, 20], cellM: 0.5 };
  const radars = [
    { map, mounting: street.radar.mounting },
    { map, mounting: other },
  ];
  const both = birdsEyeView({ radars, grid });
  const alone = radars.map((radar) => birdsEyeView({ radars: [radar], grid }));
  assert.deepEqual(both.shape, [80, 80]);
  both.power.forEach((power, k) => {
    assert.equal(power, Math.max(alone[0].power[k], alone[1].power[k]));
    assert.equal(both.seen[k], Math.max(alone[0].seen[k], alone[1].seen[k]));
    assert.equal(both.radar[k] >= 0, both.seen[k] === 1);
    if (both.radar[k] >= 0) assert.equal(alone[both.radar[k]].power[k], power);
  });
});

test('the pool makes the same image, tells how far it is, and can be stopped', async () => {
  const plain = imageFrame(street.cube, by('iaa', { from: 'targets' }));
  const told = [];
  const onProgress = (done, total) => told.push([done, total]);
  const made = await pool.imageFrame(street.cube, by('iaa', { from: 'targets' }), { onProgress });
  assert.deepEqual(made.map, plain.map);
  assert.deepEqual(told.at(-1), [plain.cells.rangeM.length, plain.cells.rangeM.length]);
  const stop = new AbortController();
  const stopped = pool.imageFrame(street.cube, by('iaa'), { signal: stop.signal, onProgress: () => stop.abort() });
  await assert.rejects(stopped, { name: 'AbortError' });
  // With transfer the cube is given away.
  const cube = { ...street.cube, data: street.cube.data.slice() };
  const moved = await pool.imageFrame(cube, by('bartlett'), { transfer: true });
  assert.equal(cube.data.length, 0);
  assert.deepEqual(moved.map, imageFrame(street.cube, by('bartlett')).map);
});

test('the capture gives an image too', async () => {
  const capture = new Capture(bin, cfg);
  const { waveform } = capture.info.config;
  const cells = capture.frameCells(0, { peakGrouping: false });
  assert.deepEqual(cells.snapshots.shape, [cells.rangeM.length, 8]);
  assert.deepEqual(await pool.captureCells(bin, cfg, 0, { peakGrouping: false }), cells);
  const { map } = await pool.imageCells(cells, { waveform, array: 'awr1642', angle: { method: 'iaa' } });
  const view = birdsEyeView({
    radars: [{ map, mounting: { xM: 0, yM: 0, yawDeg: 0 } }],
    grid: { xM: [0, 12], yM: [-6, 6], cellM: 0.05 },
  });
  assert.ok(view.power.some((power) => power > 0));
  capture.free();
});

test('what is wrong is refused by name, and the next call works', () => {
  throwsTyped(() => simulateStreet({ radar: 'back' }), 'unknown-name', 'radar');
  throwsTyped(() => streetScene({ egoSpeedMps: 99 }), 'out-of-range', 'egoSpeedMps');
  throwsTyped(() => frameCells({ data: new Float32Array(12), shape: [6] }, options), 'shape', 'cube');
  const { map, cells, estimates } = imageFrame(street.cube, by('iaa', { maxDetections: 5 }));
  const grid = { rangeM: [0, 30], ranges: 76, fieldOfViewDeg: 45, azimuths: 128 };
  const input = { cells, estimates, from: 'spectra', grid };
  const { spectra: _, ...without } = estimates;
  throwsTyped(() => rangeAzimuthMap({ ...input, estimates: without }), 'missing', 'estimates.spectra');
  throwsTyped(() => rangeAzimuthMap({ ...input, grid: { ...grid, azimuths: 1 } }), 'out-of-range', 'grid.azimuths');
  throwsTyped(
    () =>
      rangeAzimuthMap({ ...input, from: 'targets', estimates: { ...estimates, cell: estimates.cell.map(() => 99) } }),
    'out-of-range',
    'cell of an estimate',
  );
  const radars = [{ map, mounting: street.radar.mounting }];
  throwsTyped(() => birdsEyeView({ radars: [], grid: { xM: [0, 9], yM: [0, 9], cellM: 1 } }), 'out-of-range', 'radars');
  throwsTyped(
    () => birdsEyeView({ radars, grid: { xM: [0, 1e5], yM: [0, 1e5], cellM: 0.01 } }),
    'out-of-range',
    'points of x_m',
  );
  const view = birdsEyeView({ radars, grid: { xM: [0, 9], yM: [0, 9], cellM: 1 } });
  throwsTyped(() => sidelobeMeasure(view, [], { gateM: -1 }), 'out-of-range', 'gateM');
  assert.equal(sidelobeMeasure(view, [], { gateM: 1 }).outsideDb, 0);
});
