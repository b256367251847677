// Objects that lie: no call traps, throws a raw error, or changes what the next one answers.
import assert from 'node:assert/strict';
import { before, test } from 'node:test';
import * as boresight from 'boresight';
import { createPool, Pool } from 'boresight/worker';
import { generator } from '../../scripts/lib/build/generator.mjs';
import { rejectsTyped } from './lib/assert.mjs';
import { callBy, goodCalls, live } from './lib/calls.mjs';
import { lies, spoilt } from './lib/hostile.mjs';

/** Calls in all. */
const CALLS = process.env.BORESIGHT_FULL ? 20_000 : 4_000;

before(() => Promise.all([boresight.init(), boresight.initDrives()]));

test('every function and handle has a good call', () => {
  const calls = goodCalls();
  const named = new Set(Object.keys(calls).map((name) => name.split('.')[0]));
  const takesNone = ['arrayPresets', 'calibrationMethods', 'driveScenarios', 'methods', 'version', 'waveformPresets'];
  const missing = Object.entries(boresight)
    .filter(([name, value]) => typeof value === 'function' && !/^init|^BoresightError$/.test(name))
    .map(([name]) => name)
    // What it sets the calls after it feel; it has lies of its own in limits.test.mjs. What goes on over time has its
    // tests in live.test.mjs and bridge.test.mjs.
    .filter((name) => !named.has(name) && ![...takesNone, ...live, 'setLimits'].includes(name));
  assert.deepEqual(missing, []);
  for (const [name, args] of Object.entries(calls)) {
    if (name !== 'simulateStreet' && name !== 'simulateDrive') assert.doesNotThrow(() => callBy(name, args), name);
  }
});

test(`${CALLS} calls with objects that lie are answered or refused with typed errors`, async () => {
  const draw = generator(20_261_124);
  const calls = Object.entries(goodCalls());
  const kinds = Object.entries(lies);
  const good = goodCalls().estimate;
  const expected = boresight.estimate(...good);
  const reenter = () => boresight.estimate(...good);
  const failed = new Map();
  let answered = 0;
  for (let n = 0; n < CALLS; n++) {
    const [name, args] = calls[n % calls.length];
    const [kind, lie] = kinds[Math.floor(draw() * kinds.length)];
    try {
      callBy(name, spoilt(args, lie, { draw, reenter }));
      answered++;
    } catch (error) {
      const typed = error instanceof boresight.BoresightError && error.code !== 'trap';
      if (typed) continue;
      const key = `${name}, ${kind}: ${error?.code ?? error?.name} ${String(error?.message).slice(0, 120)}`;
      failed.set(key, (failed.get(key) ?? 0) + 1);
      if (error?.code === 'trap') await Promise.all([boresight.init(), boresight.initDrives()]);
    }
    if (n % 500 === 0) assert.deepEqual(boresight.estimate(...good), expected);
  }
  assert.ok(answered > 0.02 * CALLS && answered < 0.9 * CALLS, `${answered} of ${CALLS} answered`);
  assert.deepEqual(Object.fromEntries(failed), {});
});

test('an object with more properties than are read is refused before they are', () => {
  const [input, options] = goodCalls().estimate;
  const many = Object.fromEntries(Array.from({ length: 65_537 }, (_, i) => [`key${i}`, undefined]));
  for (const [spoilt, what] of [
    [{ ...options, ...many }, /^object has 6554\d properties/],
    [{ ...options, iaa: many }, /iaa/],
  ])
    assert.throws(
      () => boresight.estimate(input, spoilt),
      ({ code, message }) => code === 'too-large' && /expected at most 65536/.test(message) && what.test(message),
    );
  delete many.key0;
  assert.deepEqual(
    boresight.estimate(input, { ...options, iaa: many }),
    boresight.estimate(input, { ...options, iaa: {} }),
  );
});

test('calls of the pool without arguments, or with such that lie, reject with typed errors', async () => {
  const pool = createPool({ workers: 1 });
  const revoked = () => {
    const { proxy, revoke } = Proxy.revocable({}, {});
    revoke();
    return proxy;
  };
  const names = Object.getOwnPropertyNames(Pool.prototype).filter(
    (name) => typeof Object.getOwnPropertyDescriptor(Pool.prototype, name).value === 'function',
  );
  const given = {
    nothing: [],
    nulls: Array(6).fill(null),
    numbers: Array(6).fill(5),
    'revoked proxies': Array.from({ length: 6 }, revoked),
    'objects that throw': Array.from({ length: 6 }, () => new Proxy({}, { get: () => assert.fail('read') })),
  };
  const raw = [];
  for (const name of names.filter((name) => !/^(constructor|terminate|unloadNetwork|simulateDrive)$/.test(name))) {
    for (const [kind, args] of Object.entries(given)) {
      await pool[name](...args).catch((error) => {
        const typed = error instanceof boresight.BoresightError && error.code !== 'trap';
        if (!typed) raw.push(`${name} with ${kind}: ${error}`);
      });
    }
  }
  assert.deepEqual(raw, []);
  const good = goodCalls().estimate;
  const job = (options) => pool.estimate(...good, options);
  await rejectsTyped(job(7), 'wrong-type', 'job');
  await rejectsTyped(job({ signal: 5 }), 'wrong-type', 'job.signal');
  await rejectsTyped(job({ onProgress: 5 }), 'wrong-type', 'job.onProgress');
  await rejectsTyped(job({ transfer: 'all' }), 'wrong-type', 'job.transfer');
  const reason = new TypeError('enough');
  await assert.rejects(job({ signal: AbortSignal.abort(reason) }), reason);
  assert.deepEqual(await job(null), boresight.estimate(...good));
  pool.terminate();
});
