// Where a pool has its workers and modules from, and a pool without workers.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { after, before, describe, test } from 'node:test';
import { fileURLToPath } from 'node:url';
import { Worker } from 'node:worker_threads';
import { BoresightError, calibrateDrive, estimate, init, initDrives, setLimits, simulateDrive } from 'boresight';
import { createPool } from 'boresight/worker';
import { workHere } from '../../dist/worker/here.js';
import { planeWaves, rejectsTyped, throwsTyped } from './lib/assert.mjs';
import { bin, cfg } from './lib/recording.mjs';

const wasm = (name) => new URL(`../../dist/wasm/boresight${name}_bg.wasm`, import.meta.url);
const script = new URL('../../dist/worker/node-worker.js', import.meta.url);
const options = { method: 'bartlett', array: 'ula10' };
const inputs = Array.from({ length: 40 }, (_, i) => ({ snapshots: planeWaves(10, 2, [-50 + 2.5 * i]) }));
const drive = { scenario: 'city', durationS: 20, seed: 3 };

before(() => Promise.all([init(), initDrives()]));

describe('modules and workers that are given', () => {
  let server;
  let served;
  before(async () => {
    server = createServer((request, response) => {
      const type = request.url === '/typed.wasm' ? 'application/wasm' : 'application/octet-stream';
      if (request.url === '/none') response.writeHead(404).end();
      else response.writeHead(200, { 'Content-Type': type }).end(readFileSync(wasm('')));
    });
    await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
    served = (path) => `http://127.0.0.1:${server.address().port}/${path}`;
  });
  after(() => server.close());

  const bytes = () => readFileSync(wasm(''));
  const sources = {
    'a URL': () => wasm(''),
    'an address': () => wasm('').href,
    'an address of a server': () => served('typed.wasm'),
    'a response of another type': () => fetch(served('plain.wasm')),
    'a request': () => new Request(served('typed.wasm')),
    bytes,
    'an ArrayBuffer': () => new Uint8Array(bytes()).buffer,
    'a compiled module': () => new WebAssembly.Module(bytes()),
    'a function of bytes': () => bytes,
    'a function of a promise': () => async () => new WebAssembly.Module(bytes()),
  };
  for (const [name, source] of Object.entries(sources)) {
    test(`${name} is a module`, async () => {
      const pool = createPool({ workers: 1, modules: { core: source() } });
      assert.deepEqual(await pool.estimate(inputs[3], options), estimate(inputs[3], options));
      pool.terminate();
    });
  }

  test('what is no module is refused when it is needed, and what is needed alone is asked for', async () => {
    const asked = [];
    const modules = {
      core: () => asked.push('core') && bytes(),
      drives: () => asked.push('drives') && new Uint8Array([1, 2, 3]),
    };
    const pool = createPool({ workers: 1, modules });
    assert.deepEqual(asked, []);
    await pool.version();
    assert.deepEqual(asked, ['core']);
    await rejectsTyped(pool.driveScenarios(), 'not-loaded', 'WebAssembly module');
    await rejectsTyped(pool.driveScenarios(), 'not-loaded', 'WebAssembly module');
    assert.deepEqual(asked, ['core', 'drives', 'drives'], 'and again after a failure');
    pool.terminate();
    const typed = (core, ...how) => rejectsTyped(createPool({ workers: 1, modules: { core } }).version(), ...how);
    await typed(5, 'wrong-type', 'modules.core');
    await typed(() => null, 'wrong-type', 'modules.core');
    await typed(served('none'), 'not-loaded', 'WebAssembly module');
    await typed('no address', 'not-loaded', 'WebAssembly module');
    const throwing = () => {
      throw new RangeError('none here');
    };
    await typed(throwing, 'not-loaded', 'WebAssembly module');
    throwsTyped(() => createPool({ modules: 5 }), 'wrong-type', 'modules');
    throwsTyped(() => createPool({ modules: { network: wasm('_neural') } }), 'unknown-option', 'modules.network');
  });

  test('a worker comes from its script or from a function', async () => {
    const started = [];
    const start = () => {
      started.push(new Worker(script));
      return started.at(-1);
    };
    for (const worker of [script, start]) {
      const pool = createPool({ workers: 1, worker });
      assert.match(await pool.version(), /^\d/);
      pool.terminate();
    }
    assert.equal(started.length, 1);
    throwsTyped(() => createPool({ worker: 5 }), 'wrong-type', 'worker');
    const broken = createPool({
      worker: () => {
        throw new Error('no workers here');
      },
    });
    await rejectsTyped(broken.version(), 'worker-refused', 'worker');
    await rejectsTyped(createPool({ worker: () => 5 }).version(), 'worker-refused', 'worker');
  });

  test('options that lie are refused', () => {
    const { proxy, revoke } = Proxy.revocable({}, {});
    revoke();
    const getter = {
      get worker() {
        throw new Error('a lie');
      },
    };
    for (const given of [null, 5, [], proxy, getter, { modules: proxy }, { limits: proxy }])
      assert.throws(() => createPool(given), BoresightError);
  });

  test('slips are told: names that are no options, numbers for objects', async () => {
    throwsTyped(() => createPool({ worker_s: 1 }), 'unknown-option', 'options.worker_s');
    throwsTyped(() => createPool({ limits: 5 }), 'wrong-type', 'limits');
    const pool = createPool({ workers: 1 });
    await rejectsTyped(pool.estimate(inputs[0], options, { onprogress: () => {} }), 'unknown-option', 'job.onprogress');
    await rejectsTyped(pool.estimateMany(inputs, options, { abort: 1 }), 'unknown-option', 'job.abort');
    pool.terminate();
    throwsTyped(() => createPool({ limits: { seconds: 1 } }), 'unknown-option', 'limits.seconds');
  });

  test('the module of networks is there once boresight/neural is imported, or where it is given', () => {
    const program = fileURLToPath(new URL('lib/register-networks.mjs', import.meta.url));
    const said = execFileSync(process.execPath, [program], { encoding: 'utf8' });
    assert.deepEqual(said.trim().split('\n'), ['no-module', 'aaetr', 'aaetr', 'aaetr']);
  });
});

describe('a pool without workers', () => {
  let pool;
  before(() => {
    pool = createPool({ workers: 0 });
  });
  after(() => pool.terminate());

  test('gives what the functions give, and starts no worker', async () => {
    const none = () => assert.fail('a worker was started');
    const alone = createPool({ workers: 0, worker: none });
    assert.equal(alone.workers, 0);
    assert.deepEqual(await alone.estimate(inputs[3], options), estimate(inputs[3], options));
    alone.terminate();
    assert.deepEqual(
      await pool.estimateMany(inputs, options),
      inputs.map((input) => estimate(input, options)),
    );
    const simulated = await pool.simulateDrive(drive);
    assert.deepEqual(simulated, simulateDrive(drive));
    const calibration = { method: 'kabsch', sensor: 1 };
    assert.deepEqual(await pool.calibrateDrive(simulated, calibration), calibrateDrive(simulated, calibration));
    const snapshots = { array: 'ula8', targets: { count: [1, 1] }, snrDb: 10, seed: 1, scenes: 20 };
    const pooled = createPool({ workers: 1 });
    assert.deepEqual(await pool.simulateSnapshots(snapshots), await pooled.simulateSnapshots(snapshots));
    pooled.terminate();
  });

  test('lets the thread do what else it has to do between pieces, and says how far it is', async () => {
    const seen = [];
    const progress = [];
    const timer = setInterval(() => seen.push(progress.length), 1);
    const many = Array.from({ length: 640 }, (_, k) => inputs[k % 40]);
    await pool.estimateMany(many, options, { onProgress: (done, total) => progress.push([done, total]) });
    clearInterval(timer);
    assert.equal(progress.length, 64);
    assert.deepEqual(progress.at(-1), [640, 640]);
    assert.ok(
      seen.some((pieces) => pieces > 0 && pieces < 64),
      `a timer had its turns after ${seen} pieces`,
    );
  });

  test('a job that is cancelled between its pieces does no more of them', async () => {
    const controller = new AbortController();
    let pieces = 0;
    const onProgress = () => {
      pieces += 1;
      if (pieces === 2) setTimeout(() => controller.abort());
    };
    const many = Array.from({ length: 6400 }, (_, k) => inputs[k % 40]);
    await assert.rejects(pool.estimateMany(many, options, { signal: controller.signal, onProgress }), {
      name: 'AbortError',
    });
    const stopped = pieces;
    assert.match(await pool.version(), /^\d/);
    assert.equal(pieces, stopped);
    assert.ok(stopped < 64, `${stopped} pieces`);
  });

  test('a long piece stops where it reports', async () => {
    const controller = new AbortController();
    const done = [];
    const onProgress = (scans) => {
      done.push(scans);
      if (done.length === 3) controller.abort();
    };
    await assert.rejects(pool.simulateDrive({ ...drive, durationS: 60 }, { signal: controller.signal, onProgress }), {
      name: 'AbortError',
    });
    assert.equal(done.length, 3);
    const queued = pool.version(undefined);
    assert.match(await queued, /^\d/);
  });

  test('what is stopped does nothing more, whether it runs or waits for its turn', async () => {
    const replies = [];
    const ended = (id, stopAt) =>
      new Promise((resolve) => {
        const worker = workHere({
          reply: (reply) => {
            replies.push(reply);
            if (replies.length === stopAt) worker.stop();
            if (!('done' in reply)) resolve(reply);
          },
        });
        worker.post({ module: new WebAssembly.Module(readFileSync(wasm(''))) }, []);
        worker.post({ drives: new WebAssembly.Module(readFileSync(wasm('_drives'))) }, []);
        worker.post({ id, name: 'simulateDrive', args: [drive] }, []);
        if (stopAt === 0) worker.stop();
      });
    assert.equal((await ended(1, 3)).error.code, 'cancelled');
    assert.equal(replies.length, 4);
    assert.equal((await ended(2, 0)).error.code, 'cancelled');
    assert.equal(replies.length, 5);
  });

  test('what a callback throws rejects its job alone', async () => {
    const thrown = new Error('mine');
    const onProgress = () => {
      throw thrown;
    };
    await assert.rejects(pool.simulateDrive(drive, { onProgress }), thrown);
    assert.match(await pool.version(), /^\d/);
  });

  test('errors are typed, arguments stay the caller’s unless they are given away', async () => {
    await rejectsTyped(pool.estimate(inputs[0], { ...options, gridPoints: 2 }), 'out-of-range', 'gridPoints');
    await rejectsTyped(pool.estimate(inputs[0], { ...options, method: () => {} }), 'wrong-type', 'arguments');
    const snapshots = planeWaves(10, 2, [5]);
    await pool.estimate({ snapshots }, options);
    assert.equal(snapshots.data.length, 40);
    await pool.estimate({ snapshots }, options, { transfer: true });
    assert.equal(snapshots.data.length, 0);
  });

  test('captures of two pools are kept apart, and forgotten with their pool', async () => {
    const [one, two] = [createPool({ workers: 0 }), createPool({ workers: 0 })];
    const first = await one.loadCapture(bin, cfg);
    const second = await two.loadCapture(bin.subarray(0, first.info.config.frameBytes), cfg);
    assert.equal(second.info.frames, 1);
    assert.ok((await first.combineFrames()).detections.length > 0);
    two.terminate();
    assert.ok((await first.combineFrames()).detections.length > 0);
    await rejectsTyped(second.combineFrames(), 'terminated', 'worker pool');
    one.terminate();
  });

  test('what a running job uses is forgotten when it is done', async () => {
    const own = createPool({ workers: 0 });
    const expected = await (await pool.loadCapture(bin, cfg)).combineFrames();
    const capture = await own.loadCapture(bin, cfg);
    let freed = 0;
    const onProgress = () => {
      freed += 1;
      capture.free();
    };
    assert.deepEqual(await capture.combineFrames({}, { onProgress }), expected);
    assert.ok(freed > 1);
    await rejectsTyped(capture.combineFrames(), 'unknown-capture', 'capture');
    const kept = await own.loadCapture(bin, cfg);
    await rejectsTyped(kept.combineFrames({}, { onProgress: () => own.terminate() }), 'terminated', 'worker pool');
  });

  test('has the limits of its thread, or its own', async () => {
    setLimits({ operations: 1e3 });
    try {
      await rejectsTyped(pool.estimate(inputs[0], options), 'too-large');
      const free = createPool({ workers: 0, limits: { operations: 1e10 } });
      assert.equal((await free.estimate(inputs[0], options)).method, 'bartlett');
      free.terminate();
      throwsTyped(() => estimate(inputs[0], options), 'too-large');
    } finally {
      setLimits();
    }
  });

  test('a pool that ends rejects what waits', async () => {
    const ending = createPool({ workers: 0 });
    const jobs = [ending.estimate(inputs[0], options), ending.estimate(inputs[1], options)];
    const rejected = jobs.map((job) => rejectsTyped(job, 'terminated', 'worker pool'));
    ending.terminate();
    await Promise.all(rejected);
  });
});
