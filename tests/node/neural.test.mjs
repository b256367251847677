// Networks in wasm: PyTorch's numbers, batches, bad input, the module's life, the pool.
import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { array, estimate, frameCells, init, processCube, simulateCube, simulateSnapshots } from 'boresight';
import { BoresightError, initNeural, initNeuralSync, Network } from 'boresight/neural';
import { createPool } from 'boresight/worker';
import glue from '../../dist/wasm/boresight_neural.js';
import { forgetNetwork, keepNetwork, networkWith } from '../../dist/worker/networks.js';
import { planeWaves, rejectsTyped, throwsTyped } from './lib/assert.mjs';
import { assertShape } from './lib/interfaces.mjs';
import { difference, differenceByKind, model, names, tensor } from './lib/networks.mjs';

const pursuit = 'learned-pursuit';
/** Snapshots of `lrr48` with three targets each, as one batch. */
const scenes = (count) => {
  const { data, shape } = simulateSnapshots({
    array: 'lrr48',
    targets: { count: [3, 3], fieldOfViewDeg: 50 },
    snrDb: 25,
    scenes: count,
    seed: 5,
  });
  return { data, shape: shape.slice(0, 2) };
};
const cell = ({ data, shape }, index) => ({
  snapshots: { data: data.slice(2 * index * shape[1], 2 * (index + 1) * shape[1]), shape: [shape[1], 1] },
});

test('before initNeural() every call says so; loading can be tried again', async () => {
  throwsTyped(() => new Network(new Uint8Array(8)), 'not-initialised');
  throwsTyped(() => initNeuralSync(new Uint8Array([0, 97, 115, 109, 9])), 'not-loaded');
  await rejectsTyped(initNeural(Promise.reject(new Error('offline'))), 'not-loaded');
  await Promise.all([init(), initNeural(), initNeural()]);
});

describe('every shipped network', () => {
  assert.ok(names.length > 0);
  for (const name of names) {
    test(`${name} gives what PyTorch gives, with its card and without`, () => {
      const { onnx, card } = model(name);
      for (const options of [{ card }, { card: JSON.parse(card) }, {}]) {
        const network = new Network(onnx, options);
        const inputs = Object.fromEntries(network.inputs.map((port) => [port.name, tensor(name, port.name)]));
        const outputs = network.run(inputs);
        assert.deepEqual(
          Object.keys(outputs),
          network.outputs.map((port) => port.name),
        );
        for (const [port, given] of Object.entries(outputs)) {
          const expected = tensor(name, port);
          assert.deepEqual(given.shape, expected.shape);
          const byKind = differenceByKind(given.data, expected, port === 'targets');
          assert.ok(byKind <= 1e-4, `${port} differs by ${byKind} of its kind`);
          const apart = difference(given.data, expected.data);
          assert.ok(apart <= 1e-4, `${port} differs by ${apart}`);
        }
        // Inputs and outputs of the learned pursuit are AAETR's: without a card it counts as one.
        const { network: kind } = JSON.parse(card);
        assert.equal(network.kind, !options.card && kind === 'learned-pursuit' ? 'aaetr' : kind);
        assert.equal(network.card?.name ?? null, options.card ? name : null);
        network.free();
      }
    });
  }
});

describe('a network', () => {
  let network;
  before(() => (network = new Network(model(pursuit).onnx, { card: model(pursuit).card, array: 'lrr48' })));
  after(() => network.free());

  test('finds the targets of clean snapshots', () => {
    const { positions } = array('lrr48');
    assert.deepEqual(network.inputs.find(({ name }) => name === 'positions').axes, [48, 3]);
    for (const truth of [
      [-20, 15],
      [-41, 0, 33],
    ]) {
      const data = new Float64Array(96);
      truth.forEach((angle, source) =>
        positions.forEach(([, y], k) => {
          const phase = Math.PI * y * Math.sin((angle * Math.PI) / 180) + 2 * source;
          data[2 * k] += Math.cos(phase);
          data[2 * k + 1] += Math.sin(phase);
        }),
      );
      const result = network.estimate({ snapshots: { data, shape: [48, 1] } });
      assertShape(result, 'Estimate');
      assert.equal(result.method, 'learned-pursuit');
      const found = result.sources.map(({ azimuthDeg }) => azimuthDeg);
      truth.forEach((angle) =>
        assert.ok(
          found.some((near) => Math.abs(near - angle) < 0.5),
          `${found} for ${truth}`,
        ),
      );
    }
  });

  test('gives for a batch what it gives for each cell', () => {
    const batch = scenes(70);
    const all = network.estimateBatch({ snapshots: batch });
    assertShape(all, 'BatchEstimate');
    assert.equal(all.cells, 70);
    for (const index of [0, 31, 32, 69]) {
      const { sources } = network.estimate(cell(batch, index));
      const found = [...all.azimuthDeg].filter((_, i) => all.cell[i] === index);
      assert.equal(found.length, sources.length);
      // Products of a batch are added up in another order.
      sources.forEach(({ azimuthDeg }, i) =>
        assert.ok(Math.abs(found[i] - azimuthDeg) < 1e-3, `${found[i]} for ${azimuthDeg}`),
      );
    }
  });

  test('is refined to the best fit when asked, and keeps sources by their confidence', () => {
    const input = cell(scenes(1), 0);
    const plain = network.estimate(input);
    network.setOptions({ refine: true });
    const refined = network.estimate(input);
    network.setOptions({ confidence: 1 });
    assert.equal(network.estimate(input).sources.length, 0);
    network.setOptions({});
    assert.deepEqual(network.estimate(input), plain);
    assert.notDeepEqual(refined.sources[0].azimuthDeg, plain.sources[0].azimuthDeg);
  });

  test('refuses bad input with a typed error and goes on', () => {
    const { onnx, card } = model(pursuit);
    const input = cell(scenes(1), 0);
    const good = network.estimate(input);
    const values = tensor(pursuit, 'snapshots');
    const positions = tensor(pursuit, 'positions');
    const spoilt = { data: values.data.map((x, i) => (i === 7 ? NaN : x)), shape: values.shape };
    const other = (change) => JSON.stringify({ ...JSON.parse(card), ...change });
    const unknown = renamed(onnx, 'Gemm', 'Gomm') ?? renamed(onnx, 'MatMul', 'MatMal');
    const bad = [
      () => new Network(new Uint8Array(0)),
      () => new Network(new Uint8Array(1000).fill(7)),
      () => new Network(new TextEncoder().encode('not a network')),
      () => new Network(onnx.subarray(0, 100)),
      () => new Network(onnx.subarray(0, onnx.length >> 1)),
      () => new Network(onnx.subarray(0, onnx.length - 10)),
      () => new Network(unknown),
      () => new Network(onnx, { card: '{' }),
      () => new Network(onnx, { card: other({ sha256: '0'.repeat(64) }) }),
      () => new Network(onnx, { card: other({ network: 'counting' }) }),
      () => new Network(onnx, { card: other({ inputs: [{ name: 'snapshot', axes: ['batch', 48, 2] }] }) }),
      () => new Network(onnx, { card, gridPoint: 3 }),
      () => new Network(onnx, { card, confidence: 2 }),
      () => new Network('models/learned-pursuit.onnx'),
      () => new Network(onnx, 7),
      () => network.run({}),
      () => network.run({ snapshots: values }),
      () => network.run({ snapshots: values, position: positions }),
      () => network.run({ snapshots: values, positions, more: positions }),
      () => network.run({ snapshots: positions, positions }),
      () => network.run({ snapshots: { ...values, shape: [4, 48, 3] }, positions }),
      () => network.run({ snapshots: { data: [1, 2], shape: [2] }, positions }),
      () => network.run({ snapshots: spoilt, positions }),
      () => network.run(null),
      () => network.estimate({ snapshots: planeWaves(8, 1, [3]) }),
      () => network.estimate({}),
      () => network.estimate({ snapshots: { data: new Float64Array(96).fill(NaN), shape: [48, 1] } }),
      () => network.count(input),
      () => network.estimateRegion({ data: new Float32Array(2 * 65 * 8 * 4), shape: [65, 8, 4] }),
      () => network.setOptions({ refined: true }),
    ];
    for (const work of bad) {
      throwsTyped(work);
      assert.deepEqual(network.estimate(input), good);
    }
  });

  test('counts, and estimates from regions, where it can', () => {
    const covariance = planeWaves(8, 40, [4]);
    for (const name of names) {
      const { onnx, card } = model(name);
      const one = new Network(onnx, { card });
      if (one.kind === 'counting') {
        const counted = one.count({ snapshots: covariance });
        assertShape(counted, 'SourceProbabilities');
        assert.equal(counted.probability.length, 3);
        assert.equal(counted.sources, counted.probability.indexOf(Math.max(...counted.probability)));
        throwsTyped(() => one.estimate({ snapshots: covariance }));
      }
      if (one.kind === 'dnn') assert.equal(one.estimate({ snapshots: covariance }).method, 'dnn');
      if (one.kind === 'cnn3d' || one.kind === 'dnn') {
        const region = new Float32Array(2 * 65 * 8 * 4);
        region.set(planeWaves(8, 4, [-5]).data, 2 * 32 * 8 * 4);
        one.setOptions({ sources: 2 });
        const result = one.estimateRegion({ data: region, shape: [65, 8, 4] });
        assertShape(result, 'Estimate');
        assert.deepEqual([result.method, result.sources.length], [one.kind, 2]);
      }
      one.free();
    }
  });

  test('is freed once', () => {
    const { onnx, card } = model(pursuit);
    const one = new Network(onnx, { card });
    one.free();
    throwsTyped(() => one.free(), 'handle-freed', 'Network');
    throwsTyped(() => one.estimate({}), 'handle-freed', 'Network');
  });
});

describe('networks that answer with a spectrum', () => {
  const load = (name, options) => {
    const { onnx, card } = model(name);
    return new Network(onnx, { card, fieldOfViewDeg: 60, ...options });
  };
  const angles = ({ sources }, count) =>
    sources
      .slice(0, count)
      .map(({ azimuthDeg }) => azimuthDeg)
      .sort((a, b) => a - b);

  test('find targets of one snapshot, or of a covariance, and give the spectrum', () => {
    const cases = [
      ['unrolled-iaa', 'lrr48', 1, 'power', 0.3],
      ['covariance-cnn', 'ula16', 200, 'pseudo', 2],
      ['deep-music', 'ula16', 200, 'pseudo', 2],
    ];
    for (const [name, board, snapshots, kind, within] of cases) {
      const network = load(name, { array: board, sources: 2 });
      const targets = [{ azimuthDeg: -21.4 }, { azimuthDeg: 10.8 }];
      const { data, shape } = simulateSnapshots({ array: board, targets, snapshots, snrDb: 20, seed: 3 });
      const given = { snapshots: { data, shape: shape.slice(1) } };
      const found = network.estimate(given);
      assertShape(found, 'Estimate');
      assert.equal(found.spectrum.kind, kind);
      const errors = angles(found, 2).map((azimuth, i) => Math.abs(azimuth - targets[i].azimuthDeg));
      assert.ok(errors.length === 2 && errors.every((error) => error < within), `${name}: ${angles(found, 2)}`);
      // All with the card's field of view: 60 deg.
      assert.ok(found.spectrum.azimuthDeg.every((azimuth) => Math.abs(azimuth) <= 60 + 1e-9));
      network.free();
    }
  });

  test('say what they were not trained for, and refuse other arrays', () => {
    const few = load('covariance-cnn', { array: 'ula16', sources: 1 });
    const { warnings } = few.estimate({ snapshots: planeWaves(16, 4, [5]) });
    assert.ok(warnings.some(({ code, message }) => code === 'outside-training' && /16 to 2000/.test(message)));
    few.free();
    const other = load('unrolled-iaa', { array: 'ula16' });
    throwsTyped(() => other.estimate({ snapshots: planeWaves(16, 1, [5]) }), 'unsuitable-array');
    other.free();
  });
});

describe('a network for any array', () => {
  const { onnx, card } = model('aaetr-any');

  test('takes each, and states deviations that its errors keep', () => {
    const positions = Array.from({ length: 24 }, (_, k) => [0, 1.3 * k + 0.4 * ((k * k) % 5), 0]);
    for (const array of ['lrr48', 'cascade86', { positions }]) {
      const network = new Network(onnx, { card, array, fieldOfViewDeg: 60 });
      const { data, shape, truth } = simulateSnapshots({
        array,
        targets: { count: [3, 3], fieldOfViewDeg: 50 },
        snrDb: 25,
        scenes: 40,
        seed: 6,
      });
      const batch = { data, shape: shape.slice(0, 2) };
      const all = network.estimateBatch({ snapshots: batch });
      assertShape(all, 'BatchEstimate');
      const within = { right: 0, one: 0, two: 0 };
      for (let i = 0; i < all.cell.length; i++) {
        const errors = truth[all.cell[i]].map(({ azimuthDeg }) => Math.abs(azimuthDeg - all.azimuthDeg[i]));
        const error = Math.min(...errors);
        if (error > 1) continue;
        within.right += 1;
        within.one += error < all.azimuthDeviationDeg[i];
        within.two += error < 2 * all.azimuthDeviationDeg[i];
      }
      // 120 targets, of which some are nearer to each other than the array resolves; shares of 100 deviate by 5 in 100.
      assert.ok(within.right > 100, JSON.stringify(within));
      assert.ok(within.one / within.right > 0.5 && within.two / within.right > 0.8, JSON.stringify(within));
      const one = network.estimate(cell(batch, 0));
      assertShape(one, 'Estimate');
      const { azimuthDeg, deviation } = one.sources[0];
      const at = [...all.cell].indexOf(0);
      assert.ok(Math.abs(azimuthDeg - all.azimuthDeg[at]) < 1e-3);
      assert.ok(Math.abs(deviation.azimuthDeg - all.azimuthDeviationDeg[at]) < 1e-3 && deviation.powerDb > 0);
      // What is refined on the snapshot is no longer the network's.
      network.setOptions({ array, refine: true });
      assert.ok(network.estimate(cell(batch, 0)).sources.every((source) => !('deviation' in source)));
      network.setOptions({});
      throwsTyped(() => network.estimate(cell(batch, 0)), 'unsuitable-array');
      network.free();
    }
  });

  test('says which arrays it was trained on, and refuses inputs that do not go together', () => {
    const network = new Network(onnx, { card, array: 'ula6', fieldOfViewDeg: 60 });
    const { warnings } = network.estimate({ snapshots: { data: new Float64Array(12).fill(1), shape: [6, 1] } });
    assert.match(warnings.map(({ message }) => message).join(), /trained on 8 to 86 elements, used on an array of 6/);
    const values = (...shape) => ({ data: new Float32Array(shape.reduce((a, b) => a * b)).fill(0.5), shape });
    const { targets } = network.run({ snapshots: values(2, 9, 2), positions: values(9, 3) });
    assert.deepEqual(targets.shape, [2, 96, 5]);
    throwsTyped(() => network.run({ snapshots: values(2, 9, 2), positions: values(8, 3) }), 'shape');
    network.free();
  });
});

test('after a trap calls say so, and initNeural() gives a fresh instance', async () => {
  const { onnx, card } = model(pursuit);
  const stale = new Network(onnx, { card });
  const { memory } = await glue();
  // Nothing a caller may pass traps, so the memory under the module has to be spoilt.
  new Uint8Array(memory.buffer).fill(0xff);
  throwsTyped(() => new Network(onnx, { card }), 'trap');
  throwsTyped(() => stale.run({}), 'trap');
  // The core lives on.
  assert.ok(estimate({ snapshots: planeWaves(4, 1, [10]) }, { method: 'bartlett', array: 'ula4' }).sources.length > 0);
  await initNeural();
  throwsTyped(() => stale.run({}), 'handle-stale', 'Network');
  const fresh = new Network(onnx, { card });
  assert.equal(fresh.kind, 'learned-pursuit');
  fresh.free();
});

test('a worker keeps the plans of a network when calls without options come between', () => {
  keepNetwork('kept', model(pursuit));
  const { setOptions } = Network.prototype;
  let rebuilt = 0;
  Network.prototype.setOptions = function (options) {
    rebuilt += 1;
    return setOptions.call(this, options);
  };
  try {
    const options = { array: 'lrr48', refine: true };
    for (let turn = 0; turn < 3; turn++) {
      networkWith('kept', { ...options, network: 'kept' });
      assert.equal(networkWith('kept').kind, 'learned-pursuit');
    }
    assert.equal(rebuilt, 1);
    networkWith('kept', { ...options, refine: false });
    assert.equal(rebuilt, 2);
  } finally {
    Network.prototype.setOptions = setOptions;
    forgetNetwork('kept');
  }
});

describe('a pool', () => {
  let pool;
  let info;
  let network;
  before(async () => {
    pool = createPool({ workers: 2 });
    info = await pool.loadNetwork(model(pursuit));
    network = new Network(model(pursuit).onnx, { card: model(pursuit).card });
  });
  after(() => {
    pool.terminate();
    network.free();
  });
  const options = (more) => ({ method: 'learned-pursuit', array: 'lrr48', network: info.id, ...more });

  test('says what it has loaded', () => {
    assertShape(info, 'NetworkInfo');
    assertShape(info.inputs[0], 'NetworkPort');
    assert.deepEqual([info.kind, info.method, info.name], ['learned-pursuit', 'learned-pursuit', pursuit]);
    assert.ok(info.readyMs > 0);
  });

  test('estimates as the network itself does, one cell and many, with progress', async () => {
    const batch = scenes(40);
    network.setOptions({ array: 'lrr48', refine: true });
    assert.deepEqual(await pool.estimate(cell(batch, 3), options({ refine: true })), network.estimate(cell(batch, 3)));
    network.setOptions({ array: 'lrr48' });
    const progress = [];
    const many = await pool.estimateBatch({ snapshots: batch }, options(), {
      onProgress: (done) => progress.push(done),
    });
    const here = network.estimateBatch({ snapshots: batch });
    assert.deepEqual(many.cell, here.cell);
    assert.ok(difference(many.azimuthDeg, here.azimuthDeg) < 1e-5);
    assert.equal(progress.at(-1), 40);
    assert.ok(progress.length > 1);
    const inputs = [0, 1, 2].map((index) => cell(batch, index));
    assert.deepEqual(
      await pool.estimateMany(inputs, options()),
      inputs.map((input) => network.estimate(input)),
    );
    // The same workers run both kinds.
    assert.deepEqual(
      await pool.estimate(inputs[0], { method: 'iaa', array: 'lrr48' }),
      estimate(inputs[0], { method: 'iaa', array: 'lrr48' }),
    );
  });

  test('processes cubes and makes images with a network', async () => {
    const waveform = {
      startFrequencyHz: 76e9,
      slopeHzPerS: 30e12,
      sampleRateHz: 10e6,
      samples: 64,
      adcStartS: 0,
      chirpIntervalS: 30e-6,
      transmitters: 6,
      loops: 16,
      frameIntervalS: 0.05,
    };
    const targets = [
      { rangeM: 8, rateMps: 1, azimuthDeg: 20 },
      { rangeM: 15, rateMps: -2, azimuthDeg: -31 },
    ];
    const cube = simulateCube({ waveform, array: 'lrr48', targets, snrDb: 20, seed: 3 });
    const chain = { waveform, array: 'lrr48', angle: { method: 'learned-pursuit', network: info.id } };
    const frames = await pool.processCube(cube, chain);
    assert.deepEqual(frames, network.processCube(cube, chain));
    assertShape(frames[0], 'FrameResult');
    for (const { rangeM, azimuthDeg } of targets) {
      const near = frames[0].detections.some(
        (d) => Math.abs(d.rangeM - rangeM) < 0.5 && Math.abs(d.azimuthDeg - azimuthDeg) < 0.5,
      );
      assert.ok(near, `a target at ${azimuthDeg} deg among ${frames[0].detections.map((d) => d.azimuthDeg)}`);
    }
    const image = await pool.imageFrame(cube, chain);
    assertShape(image, 'ImageFrame');
    assert.equal(image.estimates.method, 'learned-pursuit');
    const { angle: _, ...plain } = chain;
    assert.deepEqual((await pool.frameCells(cube, chain)).rangeBin, frameCells(cube, plain).rangeBin);
    throwsTyped(() => processCube(cube, chain), 'needs-model');
  });

  test('refuses what is no network, ids it does not know, and methods without one', async () => {
    const input = cell(scenes(1), 0);
    await rejectsTyped(pool.loadNetwork({ onnx: new Uint8Array(10) }));
    await rejectsTyped(pool.loadNetwork({}), 'wrong-type');
    await rejectsTyped(pool.estimate(input, options({ network: 'network-99' })), 'unknown-network', 'network');
    await rejectsTyped(pool.estimate(input, options({ network: undefined })), 'needs-model');
    await rejectsTyped(pool.estimate(input, options({ method: 'dnn' })));
    await rejectsTyped(pool.estimate({}, options()), 'wrong-type');
    assert.equal((await pool.estimate(input, options())).method, 'learned-pursuit');
  });

  test('goes on after a job is cancelled, and forgets a network when told to', async () => {
    const controller = new AbortController();
    const job = pool.estimateBatch({ snapshots: scenes(400) }, options(), {
      signal: controller.signal,
      onProgress: () => controller.abort(),
    });
    await assert.rejects(job, { name: 'AbortError' });
    const other = await pool.loadNetwork(model(pursuit));
    const input = cell(scenes(1), 0);
    assert.notEqual(other.id, info.id);
    assert.deepEqual(await pool.estimate(input, options({ network: other.id })), await pool.estimate(input, options()));
    assert.equal(pool.unloadNetwork(other.id), true);
    assert.equal(pool.unloadNetwork(other.id), false);
    await rejectsTyped(pool.estimate(input, options({ network: other.id })), 'unknown-network');
  });
});

/** A copy of a file in which a text is another of the same length; null where it does not occur. */
function renamed(bytes, from, to) {
  const at = Buffer.from(bytes).indexOf(from);
  if (at < 0) return null;
  const copy = Buffer.from(bytes);
  for (let next = at; next >= 0; next = copy.indexOf(from, next)) copy.write(to, next);
  return new Uint8Array(copy);
}

test('errors are those of the package', () => assert.equal(new BoresightError('a', 'b', {}).name, 'BoresightError'));
