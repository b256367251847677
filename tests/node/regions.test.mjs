// Regions of the range spectrum and their targets by networks: a simulated cube, the recorded capture, a pool; sources of
// other methods counted by a network.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { estimate, init, simulateCube, waveformPreset } from 'boresight';
import { captureRegions, cubeRegions, initNeural, Network } from 'boresight/neural';
import { createPool } from 'boresight/worker';
import { planeWaves, rejectsTyped, throwsTyped } from './lib/assert.mjs';
import { assertShape } from './lib/interfaces.mjs';
import { model } from './lib/networks.mjs';
import { bin, cfg } from './lib/recording.mjs';

const named = { counting: 'counting-small', one: 'dnn-small-1', two: 'dnn-small-2' };
let radar;
let cube;
let networks;
let pool;
let ids;

before(async () => {
  await Promise.all([init(), initNeural()]);
  radar = { waveform: waveformPreset('3dcnn-simulated'), array: 'ula8' };
  const targets = [
    { rangeM: 70, azimuthDeg: -4 },
    { rangeM: 160, azimuthDeg: -6 },
    { rangeM: 166, azimuthDeg: 5 },
  ];
  cube = simulateCube({ ...radar, snrDb: 10, seed: 2, targets });
  networks = instances(named);
  pool = createPool({ workers: 2 });
  ids = await loaded(named);
});

/** Networks of this thread, by role. */
function instances(names) {
  const make = ([role, name]) => [role, new Network(model(name).onnx, { card: model(name).card })];
  return Object.fromEntries(Object.entries(names).map(make));
}

/** Ids of networks on the pool, by role. */
async function loaded(names) {
  const load = async ([role, name]) => [role, (await pool.loadNetwork(model(name))).id];
  return Object.fromEntries(await Promise.all(Object.entries(names).map(load)));
}

after(() => {
  pool.terminate();
  for (const network of Object.values(networks)) network.free();
});

/** For a recording: windowed, a bin to itself, and loaded; the networks are those of boards that are not calibrated. */
const ofBoard = { regionWindow: 'hann', reachBins: 0, countLoading: 1 };
const boards = { counting: 'counting-experiment', one: 'cnn3d-experiment-1', two: 'cnn3d-experiment-2' };

test('a region of one target and one of two are told as they are, on a pool too', async () => {
  const { counting, ...angles } = networks;
  const frames = counting.cubeRegions(angles, cube, radar);
  const [frame] = frames;
  assertShape(frame, 'RegionFrame');
  assertShape(frame.counts, 'RegionCounts');
  assert.equal(frame.regions.length, 2);
  const found = frame.regions.map((region) => {
    assertShape(region, 'TargetRegion');
    assertShape(region.targets[0], 'RegionTarget');
    return [region.sources, ...region.targets.map(({ azimuthDeg }) => Math.round(azimuthDeg)).sort((a, b) => a - b)];
  });
  found.sort(([a], [b]) => a - b);
  assert.deepEqual(found, [
    [1, -4],
    [2, -6, 5],
  ]);
  assert.deepEqual(await pool.cubeRegions(ids, cube, radar), frames);
});

test('without networks ranges and angles are fitted, with standard deviations', () => {
  const [frame] = cubeRegions(cube, radar);
  assertShape(frame, 'RegionFrame');
  const found = frame.regions.flatMap(({ targets }) => targets).sort((a, b) => a.rangeM - b.rangeM);
  const truth = [
    [70, -4],
    [160, -6],
    [166, 5],
  ];
  assert.equal(found.length, truth.length);
  for (const [k, [rangeM, azimuthDeg]] of truth.entries()) {
    const target = found[k];
    assertShape(target, 'RegionTarget');
    assert.ok(Math.abs(target.rangeM - rangeM) < 4 * target.rangeDeviationM, JSON.stringify(target));
    assert.ok(Math.abs(target.azimuthDeg - azimuthDeg) < 4 * target.azimuthDeviationDeg, JSON.stringify(target));
  }
  throwsTyped(() => cubeRegions(cube, { ...radar, regionWindow: 'hann' }), 'incompatible');
  // The board is not calibrated.
  const [recorded] = captureRegions(bin, cfg, { mismatchDb: -13.6 }, 3);
  const { targets } = recorded.regions.find(({ rangeBin }) => rangeBin === 97);
  assert.ok(Math.abs(targets[0].azimuthDeg - -0.4) < 1, JSON.stringify(targets));
});

test('the recorded targets are one each, in every frame', async () => {
  const kept = await pool.loadCapture(bin, cfg);
  const onPool = await loaded(boards);
  const frames = await kept.regions(onPool, ofBoard);
  assert.deepEqual(
    frames.map(({ frame }) => frame),
    [0, 1, 2, 3, 4, 5, 6, 7],
  );
  for (const { regions } of frames) {
    for (const [rangeBin, classicalDeg] of [
      [58, -11.1],
      [97, -0.4],
    ]) {
      const region = regions.find((one) => one.rangeBin === rangeBin);
      assert.equal(region.sources, 1);
      assert.ok(Math.abs(region.targets[0].azimuthDeg - classicalDeg) < 1, JSON.stringify(region.targets));
    }
  }
  assert.deepEqual(await kept.frameRegions(onPool, 3, ofBoard), frames[3]);
  const here = instances(boards);
  const { counting, ...angles } = here;
  assert.deepEqual(counting.captureRegions(angles, bin, cfg, ofBoard, 3), [frames[3]]);
  for (const network of Object.values(here)) network.free();
  await rejectsTyped(kept.frameRegions(onPool, 8, ofBoard), 'out-of-range', 'frame');
  kept.free();
});

test('networks of other kinds are refused, and unknown ones', async () => {
  const { counting, one, two } = networks;
  throwsTyped(() => one.cubeRegions({ one, two: counting }, cube, radar));
  throwsTyped(() => counting.cubeRegions({ one: two, two: one }, cube, radar), 'wrong-network');
  throwsTyped(
    () => counting.cubeRegions({ one, two }, cube, { ...radar, maxRegions: 0 }),
    'out-of-range',
    'maxRegions',
  );
  throwsTyped(() => counting.cubeRegions({ one, two }, cube, { ...radar, rotate: 'never' }));
  await rejectsTyped(pool.cubeRegions({ ...ids, two: 'none' }, cube, radar), 'unknown-network');
});

test('a network counts the sources of other methods', async () => {
  const snapshots = planeWaves(8, 40, [4]);
  const options = { method: 'root-music', array: 'ula8', sources: 'network' };
  throwsTyped(() => estimate({ snapshots }, options), 'needs-counting-network', 'sources');
  const { sources } = await pool.estimate({ snapshots }, { ...options, network: ids.counting });
  assert.equal(sources.length, networks.counting.count({ snapshots }).sources);
});
