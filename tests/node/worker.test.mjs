import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { BoresightError, Capture, Estimator, estimate, init } from 'boresight';
import { createPool } from 'boresight/worker';
import { Crew } from '../../dist/worker/pool.js';
import { serve } from '../../dist/worker/serve.js';
import { batchOf, planeWaves, rejectsTyped, throwsTyped } from './lib/assert.mjs';
import { bin, cfg } from './lib/recording.mjs';

const options = { method: 'bartlett', array: 'ula10' };
const angles = Array.from({ length: 40 }, (_, i) => -50 + 2.5 * i);
const inputs = angles.map((angle) => ({ snapshots: planeWaves(10, 2, [angle]) }));

/** More work than any test waits for: some 20 s on one worker. */
const endless = () => {
  const snapshots = planeWaves(10, 200, [3]);
  return [Array.from({ length: 2000 }, () => ({ snapshots })), { ...options, gridPoints: 65536 }];
};

describe('a pool of worker threads', () => {
  let pool;
  before(async () => {
    await init();
    pool = createPool({ workers: 2 });
  });
  after(() => pool.terminate());

  test('gives what the functions give', async () => {
    assert.deepEqual(await pool.estimate(inputs[3], options), estimate(inputs[3], options));
    const [version, presets, methods, geometry] = await Promise.all([
      pool.version(),
      pool.arrayPresets(),
      pool.methods(),
      pool.array('ula8'),
    ]);
    assert.match(version, /^\d+\.\d+\.\d+/);
    assert.ok(presets.includes('lrr48'));
    assert.deepEqual(
      methods.filter(({ network }) => network).map(({ name }) => name),
      ['aaetr', 'learned-pursuit', 'dnn', 'cnn3d', 'unrolled-iaa', 'covariance-cnn', 'deep-music'],
    );
    assert.equal(methods.length, 20);
    assert.equal(geometry.positions.length, 8);
  });

  test('splits many inputs, keeps their order and says how far it is', async () => {
    const progress = [];
    const estimates = await pool.estimateMany(inputs, options, {
      onProgress: (done, total) => progress.push([done, total]),
    });
    const found = estimates.map(({ sources }) => sources[0].azimuthDeg);
    // A single noiseless source: only the grid of 1024 sines and the parabola stand in between.
    found.forEach((angle, i) => assert.ok(Math.abs(angle - angles[i]) < 0.05, `${angle} for ${angles[i]}`));
    assert.equal(progress.length, 16);
    assert.deepEqual(progress.at(-1), [40, 40]);
    assert.ok(progress.every(([done], i) => i === 0 || done > progress[i - 1][0]));
    assert.deepEqual(await pool.estimateMany([], options), []);
  });

  test('leaves the caller its arrays, unless they are given away', async () => {
    const snapshots = planeWaves(10, 2, [5]);
    const whole = new Float64Array(snapshots.data.length + 8);
    whole.set(snapshots.data, 8);
    const view = { snapshots: { data: whole.subarray(8), shape: snapshots.shape } };
    const kept = await pool.estimate(view, options);
    assert.deepEqual(kept, await pool.estimate({ snapshots }, options));
    assert.equal(whole.length, snapshots.data.length + 8);
    await pool.estimate({ snapshots }, options, { transfer: true });
    assert.equal(snapshots.data.length, 0);
  });

  test('rejects with the typed error of the function and goes on', async () => {
    await rejectsTyped(pool.estimate(inputs[0], { ...options, gridPoints: 2 }), 'out-of-range', 'gridPoints');
    await rejectsTyped(pool.estimateMany([inputs[0], {}], options), 'wrong-type', 'input');
    await rejectsTyped(pool.estimate(inputs[0], { ...options, method: () => {} }), 'wrong-type', 'arguments');
    assert.equal((await pool.estimate(inputs[0], options)).method, 'bartlett');
  });

  test('splits a batch over cells and gives what one estimator gives for all', async () => {
    const cells = batchOf(inputs.map(({ snapshots }) => snapshots));
    const progress = [];
    const onProgress = (done, total) => progress.push([done, total]);
    const batch = await pool.estimateBatch({ snapshots: cells }, { ...options, spectra: true }, { onProgress });
    const estimator = new Estimator(options);
    assert.deepEqual(batch, estimator.estimateBatch({ snapshots: cells }, { spectra: true }));
    estimator.free();
    assert.equal(progress.length, 16);
    assert.deepEqual(progress.at(-1), [40, 40]);
    assert.deepEqual(batch.spectra.shape, [40, 1024]);
    const none = await pool.estimateBatch({ snapshots: { data: new Float64Array(0), shape: [0, 10] } }, options);
    assert.deepEqual([none.cells, none.cell.length], [0, 0]);
  });

  test('counts the warnings of a batch, and its cells, over all pieces', async () => {
    const silent = { data: new Float64Array(20 * 9 * 2), shape: [9, 10, 2] };
    const batch = await pool.estimateBatch({ snapshots: silent }, options);
    assert.deepEqual(
      batch.warnings.map(({ code, cells }) => [code, cells]),
      [['no-sources', 9]],
    );
    assert.deepEqual([batch.cells, batch.unresolved, batch.cell.length], [9, 9, 0]);
    const pairs = batchOf([inputs[3], inputs[3], inputs[7]].map(({ snapshots }) => snapshots));
    assert.deepEqual(
      [...(await pool.estimateBatch({ snapshots: pairs }, { ...options, maxPeaks: 1 })).cell],
      [0, 1, 2],
    );
  });

  test('refuses what is no batch, and the next one is fine', async () => {
    const snapshots = batchOf(inputs.slice(0, 4).map(({ snapshots }) => snapshots));
    const refused = (input, own, ...how) => rejectsTyped(pool.estimateBatch(input, own), ...how);
    await refused(undefined, options, 'wrong-type', 'input');
    await refused({ snapshots: inputs[0] }, options, 'missing', 'input.snapshots.data');
    await refused({ snapshots: { ...snapshots, shape: [5, 10, 2] } }, options, 'shape', 'input.snapshots.data');
    await refused({ snapshots: { ...snapshots, shape: [80] } }, options, 'shape', 'snapshots');
    await refused({ snapshots, covariance: snapshots }, options, 'unknown-option', 'input.covariance');
    await refused({ snapshots }, { ...options, spectra: 1 }, 'wrong-type', 'spectra');
    await refused({ snapshots }, { ...options, gridPoints: 2n }, 'wrong-type', 'gridPoints');
    await refused({ snapshots }, undefined, 'missing', 'method');
    const data = snapshots.data.slice();
    data[2 * 3 * 20 - 1] = Number.NaN;
    await refused({ snapshots: { ...snapshots, data } }, options, 'not-finite', 'snapshots');
    assert.equal((await pool.estimateBatch({ snapshots }, options)).cells, 4);
  });

  test('cancels promptly although the workers are busy, and works on', async () => {
    const controller = new AbortController();
    const job = pool.estimateMany(...endless(), { signal: controller.signal });
    const outcome = assert.rejects(job, { name: 'AbortError' });
    await new Promise((resolve) => setTimeout(resolve, 300));
    controller.abort();
    await outcome;
    assert.equal((await pool.estimate(inputs[0], options)).method, 'bartlett');
  });

  test('rejects at once where the signal is aborted already, with its reason', async () => {
    const reason = new Error('enough');
    const signal = AbortSignal.abort(reason);
    await assert.rejects(pool.estimate(inputs[0], options, { signal }), reason);
  });

  test('passes on what onProgress throws', async () => {
    const onProgress = () => {
      throw new RangeError('mine');
    };
    await assert.rejects(pool.estimateMany(inputs, options, { onProgress }), { name: 'RangeError', message: 'mine' });
    assert.equal((await pool.estimate(inputs[0], options)).method, 'bartlett');
  });

  test('ends what is under way when terminated', async () => {
    const short = createPool({ workers: 1 });
    const outcomes = [short.estimateMany(...endless()), short.version()].map((job) => rejectsTyped(job, 'terminated'));
    await new Promise((resolve) => setTimeout(resolve, 300));
    short.terminate();
    await Promise.all(outcomes);
    await rejectsTyped(short.version(), 'terminated');
  });

  test('keeps a capture, which then gives what it gives here', async () => {
    const here = new Capture(bin, cfg);
    const kept = await pool.loadCapture(bin, cfg);
    assert.deepEqual(kept.info, here.info);
    const cell = { rangeBin: 58, dopplerBin: 8 };
    const angle = { method: 'capon', sources: 1 };
    const progress = [];
    assert.deepEqual(await kept.processFrame(3), here.processFrame(3));
    assert.deepEqual(
      await kept.processFrames(),
      Array.from({ length: here.info.frames }, (_, frame) => here.processFrame(frame)),
    );
    assert.deepEqual(
      await kept.combineFrames({ angle }, { onProgress: (done, total) => progress.push([done, total]) }),
      here.combineFrames({ angle }),
    );
    assert.ok(progress.length > 1 && progress.at(-1)[0] === progress.at(-1)[1]);
    assert.deepEqual(await kept.frameCells(2), here.frameCells(2));
    for (const one of [cell, { ...cell, frame: 5 }]) {
      assert.deepEqual(await kept.cellSnapshots(one), here.cellSnapshots(one));
      assert.deepEqual(await kept.explainCell(one), here.explainCell(one));
      assert.deepEqual(await kept.cellSpectrum(one, angle), here.cellSpectrum(one, angle));
    }
    for (const frame of [8, -1, 0.5]) {
      await rejectsTyped(kept.processFrame(frame), 'out-of-range');
      await rejectsTyped(kept.cellSpectrum({ ...cell, frame }, angle), 'out-of-range');
    }
    assert.equal(bin.length, 8 * here.info.config.frameBytes, 'the caller keeps its bytes');
    here.free();
    kept.free();
    await rejectsTyped(kept.combineFrames(), 'unknown-capture', 'capture');
    await rejectsTyped(pool.loadCapture(bin.subarray(0, 10), cfg));
    await rejectsTyped(pool.loadCapture('bytes', cfg), 'wrong-type', 'capture');
  });

  test('refuses an impossible number of workers', () => {
    for (const workers of [-1, 1.5, 65, Number.NaN, '2'])
      throwsTyped(() => createPool({ workers }), 'out-of-range', 'workers');
  });
});

describe('the crew', () => {
  /** Workers that do what `behave` says when they are given a piece. */
  const crewOf = (behave, size = 1) => {
    const spawned = [];
    const runtime = {
      workers: () => size,
      packaged: () => ({ core: new WebAssembly.Module(new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0])) }),
      spawn(events) {
        const worker = {
          alive: true,
          kept: [],
          terminate() {
            this.alive = false;
          },
          keepAlive() {},
        };
        worker.post = (message) => {
          if ('keep' in message) worker.kept.push(message.of);
          if ('id' in message) queueMicrotask(() => behave(events, message, spawned.length));
        };
        spawned.push(worker);
        return worker;
      },
    };
    return { crew: new Crew(runtime), spawned };
  };
  const piece = { name: 'version', args: [], units: 1 };

  test('replaces a worker that died and rejects its job with a typed error', async () => {
    const { crew, spawned } = crewOf((events, { id }, nth) =>
      nth === 1 ? events.lost('out of memory') : events.reply({ id, result: nth }),
    );
    const [first, second] = [crew.run([piece]), crew.run([piece])];
    await rejectsTyped(first, 'worker-lost', 'worker');
    assert.deepEqual(await second, [2]);
    assert.deepEqual(
      spawned.map(({ alive }) => alive),
      [false, true],
    );
  });

  test('tells apart a worker that the host does not let start', async () => {
    const { crew } = crewOf((events) => events.refused('its script was refused'));
    await rejectsTyped(crew.run([piece]), 'worker-refused', 'worker');
    const thrown = new Crew(
      {
        packaged: () => ({ core: new WebAssembly.Module(new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0])) }),
        spawn: () => {
          throw new Error('Worker is not defined');
        },
      },
      { workers: 2 },
    );
    const jobs = [thrown.run([piece, piece, piece]), thrown.run([piece])];
    await rejectsTyped(jobs[0], 'worker-refused', 'worker');
    await rejectsTyped(jobs[1], 'worker-refused', 'worker');
  });

  test('asks a worker that can stop to do so, and keeps it', async () => {
    const plain = { code: 'cancelled', message: 'm', what: 'w', expected: 'e', given: 'g' };
    let stops = 0;
    let asked;
    const { crew, spawned } = crewOf((events, { id }) => {
      asked = () => events.reply({ id, error: plain });
      if (stops > 0) events.reply({ id, result: id });
      else {
        spawned[0].stop = () => {
          stops += 1;
          queueMicrotask(asked);
        };
        controller.abort();
      }
    });
    const controller = new AbortController();
    await assert.rejects(crew.run([piece, piece], { signal: controller.signal }), { name: 'AbortError' });
    assert.equal(stops, 1);
    assert.deepEqual(await crew.run([piece]), [2]);
    assert.deepEqual([spawned.length, spawned[0].alive], [1, true]);
  });

  test('replaces a worker whose memory stays large beside the files that it keeps', async () => {
    let memoryBytes = 900 * 2 ** 20;
    const { crew, spawned } = crewOf((events, { id }, nth) => events.reply({ id, result: nth, memoryBytes }));
    const capture = crew.addCapture({ bytes: { byteLength: 300 * 2 ** 20 } });
    assert.deepEqual(await crew.run([piece]), [1]);
    memoryBytes = 1800 * 2 ** 20;
    assert.deepEqual(await crew.run([{ ...piece, capture }]), [1], 'it keeps a large file');
    memoryBytes = 2000 * 2 ** 20;
    assert.deepEqual(await crew.run([piece]), [1], 'what is done counts');
    assert.deepEqual(await crew.run([{ ...piece, capture }]), [2]);
    assert.deepEqual(
      spawned.map(({ kept }) => kept),
      [[capture], [capture]],
    );
    assert.equal(spawned[0].alive, false);
  });

  test('a worker tells what memory it holds', async () => {
    await init();
    const replies = [];
    const answer = serve((reply) => replies.push(reply));
    answer({ module: new WebAssembly.Module(new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0])) });
    answer({ id: 1, name: 'version', args: [] });
    assert.ok(replies[0].memoryBytes >= 2 ** 20, `${replies[0].memoryBytes} bytes`);
  });

  test('sends a capture to a worker once, and to no more workers than its size allows', async () => {
    const { crew, spawned } = crewOf((events, { id }) => setImmediate(() => events.reply({ id, result: id })), 4);
    const copies = (id) => spawned.map(({ kept }) => kept.filter((one) => one === id).length);
    const small = crew.addCapture({ bytes: new Uint8Array(1000) });
    // 200 MiB, for all that the crew looks at.
    const large = crew.addCapture({ bytes: { byteLength: 200 * 2 ** 20 } });
    const of = (capture) => Array.from({ length: 12 }, () => ({ ...piece, capture }));
    for (let run = 0; run < 3; run++) {
      const [all] = await Promise.all([crew.run(of(large)), crew.run(of(small)), crew.run(of(undefined))]);
      assert.equal(all.length, 12);
    }
    assert.deepEqual(copies(large).sort(), [0, 0, 0, 1]);
    assert.ok(copies(small).every((count) => count <= 1));
    assert.equal(crew.remove('network', large), false);
    assert.equal(crew.remove('capture', large), true);
    await rejectsTyped(crew.run(of(large)), 'unknown-capture', 'capture');
  });

  test('gives a capture to the worker that replaces one that died', async () => {
    const { crew, spawned } = crewOf((events, { id }, nth) =>
      nth === 1 ? events.lost('out of memory') : events.reply({ id, result: nth }),
    );
    const capture = crew.addCapture({ bytes: new Uint8Array(10) });
    await rejectsTyped(crew.run([{ ...piece, capture }]), 'worker-lost', 'worker');
    assert.deepEqual(await crew.run([{ ...piece, capture }]), [2]);
    assert.deepEqual(
      spawned.map(({ kept }) => kept),
      [[capture], [capture]],
    );
  });

  test('drops the rest of a job whose first piece failed', async () => {
    const plain = { code: 'shape', message: 'm', what: 'w', expected: 'e', given: 'g' };
    let pieces = 0;
    const { crew } = crewOf((events, { id }) => {
      pieces += 1;
      events.reply({ id, error: plain });
    });
    await assert.rejects(
      crew.run([piece, piece, piece]),
      (error) => error instanceof BoresightError && error.code === 'shape',
    );
    assert.equal(pieces, 1);
  });

  test('tries to load the module again after a failure', async () => {
    let tries = 0;
    const { crew } = crewOf((events, { id }) => events.reply({ id, result: 'ok' }));
    const broken = new Crew(
      {
        workers: () => 1,
        packaged: () => ({
          core: async () => {
            if (++tries === 1) throw new Error('offline');
            return new WebAssembly.Module(new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0]));
          },
        }),
        spawn: () => {
          throw new Error('not reached');
        },
      },
      { workers: 1 },
    );
    await rejectsTyped(broken.run([piece]), 'not-loaded');
    assert.deepEqual(await broken.run([]), []);
    assert.deepEqual(await crew.run([piece]), ['ok']);
  });
});
