/** Storages whose n-th call fails, for every n: what was acknowledged is there, and nothing is half written. */
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { initDrives } from 'boresight';
import { configOf } from '../src/config.js';
import { openFiles } from '../src/storage/files.js';
import { openSqlite } from '../src/storage/sqlite.js';
import { Vehicle } from '../src/vehicle.js';
import { frames, line, RADAR, reference } from './lib/drive.mjs';
import { Expected, FAULTS, FaultyDatabase, MemoryDisk } from './lib/faults.mjs';
import { randomOf } from './lib/random.mjs';

const NAMES = ['vehicle/a', 'vehicle/b', 'fleet/c'];
const ROUNDS = 4;
const encoder = new TextEncoder();
const decoder = new TextDecoder();

/** A promise with what settles it. */
function resolvers() {
  const made = {};
  made.promise = new Promise((resolve, reject) => Object.assign(made, { resolve, reject }));
  return made;
}

/** What an object holds, as one string that can be compared. */
const stateOf = (storage) =>
  [...storage.read()]
    .map(([key, value]) => `${key}=${decoder.decode(value)}`)
    .sort()
    .join();
const changed = (change) => (state) => {
  const values = new Map(state ? state.split(',').map((pair) => pair.split('=')) : []);
  change(values);
  return [...values]
    .map((pair) => pair.join('='))
    .sort()
    .join();
};

/** Writes of an object: two keys a round, one of them taken away in the next, an alarm, and in the end all of it cleared. */
function* writesOf(name) {
  for (let round = 0; round < ROUNDS; round++) {
    const [key, last] = [`k${round}`, `k${round - 1}`];
    yield {
      apply: changed((values) => values.set(key, `${round}`).set('x', `${round}`) && values.delete(last)),
      write: (storage) =>
        storage.write([
          [key, encoder.encode(`${round}`)],
          ['x', encoder.encode(`${round}`)],
          [last, null],
        ]),
    };
    if (round === 1) yield { apply: (state) => state, write: (storage) => storage.setAlarm(1000 + round) };
    if (round === 2 && name === NAMES[1]) yield { apply: () => '', write: (storage) => storage.clear() };
  }
}

/** Has all objects write at the same time, one write of each after the other; gives their storages. */
function drive(database, expected) {
  return Promise.all(
    NAMES.map(async (name) => {
      const storage = database.open(name);
      for (const { apply, write } of writesOf(name)) {
        const acknowledged = await (async () => write(storage))().then(
          () => true,
          () => false,
        );
        expected.get(name).add(apply, acknowledged);
      }
      return storage;
    }),
  );
}

const expectations = () => new Map(NAMES.map((name) => [name, new Expected()]));
/** Whether objects hold what was acknowledged, those that are open too. */
function check(database, expected, open = []) {
  for (const [i, name] of NAMES.entries()) {
    const state = stateOf(database.open(name));
    assert.ok(expected.get(name).allows(state), `${name} holds ${state}`);
    if (open[i]) assert.equal(stateOf(open[i]), state, `${name}, which is open`);
  }
}

/** Runs a case for every call that a fault can come at; counts the faults. */
async function sweep(faults, run) {
  const counts = await Promise.all(
    faults.map(async (fault) => {
      // Cases beside each other, since each waits for writes to be gathered.
      for (let from = 1, hits = 0; ; from += 64) {
        const cases = await Promise.all(Array.from({ length: 64 }, (_, i) => run(fault, from + i)));
        hits += cases.filter(Boolean).length;
        if (!cases.at(-1)) return hits;
      }
    }),
  );
  return counts.reduce((sum, count) => sum + count, 0);
}

test('files: no fault and no power cut loses what was acknowledged', async (context) => {
  let acknowledgedAfter = 0;
  const injected = await sweep(FAULTS, async (fault, at) => {
    const random = randomOf(at);
    const disk = new MemoryDisk();
    const trigger = disk.inject(fault, at);
    const expected = expectations();
    let database;
    let open;
    try {
      database = openFiles('/data', disk);
      open = await drive(database, expected);
    } catch (error) {
      // It did not start.
      assert.ok(!database, error);
    }
    const { hit } = trigger;
    if (!fault.cut && database) {
      trigger.heal();
      check(database, expected, open);
      await drive(database, expected);
      acknowledgedAfter += 1;
      for (const name of NAMES) assert.equal(stateOf(database.open(name)), 'k3=3,x=3');
    }
    for (let cut = 0; cut < 2; cut++) {
      const restarted = openFiles('/data', disk.afterCut(random));
      check(restarted, expected);
      restarted.alarms();
      assert.deepEqual([...restarted.unreadable], [], 'a partial file under its name');
    }
    return hit;
  });
  context.diagnostic(`files: ${injected} faults injected, 0 acknowledged writes lost`);
  assert.ok(injected >= 500, `${injected} faults`);
  assert.ok(acknowledgedAfter > 0);
});

test('files: a write that fails takes nothing from those that wait behind it', async () => {
  const disk = new MemoryDisk();
  const { rename } = disk;
  const begun = resolvers();
  const fails = resolvers();
  disk.rename = () => {
    disk.rename = rename;
    begun.resolve();
    return fails.promise;
  };
  const storage = openFiles('/data', disk).open('vehicle/a');
  const put = (key) => storage.write([[key, encoder.encode('1')]]);
  const first = put('a');
  await begun.promise;
  const second = put('b');
  fails.reject(new Error('the disk is full'));
  await assert.rejects(first);
  await Promise.all([second, put('c')]);
  assert.equal(stateOf(openFiles('/data', disk).open('vehicle/a')), 'a=1,b=1,c=1');
});

test('sqlite: no fault loses what was acknowledged, nor leaves a transaction open', async (context) => {
  const sqlite = await import('node:sqlite').catch(() => undefined);
  if (!sqlite) return context.skip('this runtime has no SQLite');
  const faults = FAULTS.filter(({ short, cut }) => !short && !cut);
  const injected = await sweep(faults, async (fault, at) => {
    const db = new sqlite.DatabaseSync(':memory:');
    const faulty = new FaultyDatabase(db);
    const expected = expectations();
    const database = await openSqlite('', async () => faulty);
    const trigger = faulty.inject(fault, at);
    const open = await drive(database, expected);
    const { hit } = trigger;
    trigger.heal();
    check(database, expected, open);
    await drive(database, expected);
    for (const name of NAMES) assert.equal(stateOf(database.open(name)), 'k3=3,x=3');
    db.close();
    return hit;
  });
  context.diagnostic(`sqlite: ${injected} faults injected, 0 acknowledged writes lost`);
  assert.ok(injected >= 100, `${injected} faults`);
});

test('a vehicle whose disk fails or loses its power has every frame once, and the digits of a drive without', async (context) => {
  context.mock.method(console, 'error', () => {});
  await initDrives();
  const all = (await frames({ durationS: 3, detections: 24 })).slice(0, 24);
  const wanted = await reference(all);
  const config = configOf({ tenants: {} });
  const fleet = { admit: async () => true, tell: async () => {}, quarantine: async () => {}, forget: async () => true };
  const faults = [
    { code: 'ENOSPC', lasts: true },
    { code: 'EIO' },
    { short: true, code: 'ENOSPC', calls: 'write' },
    { cut: true },
  ];
  let injected = 0;
  for (const fault of faults) {
    for (let at = 1, hit = true; hit; at++) {
      const random = randomOf(at);
      let disk = new MemoryDisk();
      const trigger = disk.inject(fault, at);
      const start = () => {
        const storage = openFiles('/data', disk).open('vehicle/test/car');
        return new Vehicle(storage, config, () => fleet);
      };
      let live;
      /** Asks until it is acknowledged, as a client does; a service that ended is started again. */
      const acknowledged = async (action, type, body) => {
        for (let attempt = 0; attempt < 4; attempt++) {
          try {
            live ??= start();
          } catch {
            if (!trigger.isCut) trigger.heal();
          }
          const headers = { 'content-type': type, 'content-length': String(encoder.encode(body).length) };
          const request = new Request('https://vehicle/', { method: 'POST', body, headers });
          const answer = await live?.answer({ tenant: 'test', vehicle: 'car', action, radar: 'front' }, request);
          if (answer?.ok) return answer.json();
          if (answer) assert.equal(answer.status, 503);
          if (trigger.isCut) {
            disk = disk.afterCut(random);
            live?.rest();
            live = undefined;
            trigger.isCut = false;
          }
          trigger.heal();
        }
        throw new Error('not acknowledged');
      };
      await acknowledged('configure', 'application/json', JSON.stringify(RADAR));
      for (let from = 0; from < all.length; from += 8) {
        const body = all.slice(from, from + 8).map((frame) => line('front', frame));
        const { accepted, repeated } = await acknowledged('take', 'application/x-ndjson', body.join(''));
        assert.equal(accepted + repeated, 8);
      }
      // The power is cut once more, after the last answer.
      disk = disk.afterCut(random);
      live.rest();
      live = start();
      const answer = await live.answer(
        { tenant: 'test', vehicle: 'car', action: 'describe' },
        new Request('https://vehicle/'),
      );
      const { radars } = await answer.json();
      assert.deepEqual([radars[0].frames, radars[0].result], [all.length, wanted]);
      live.rest();
      hit = trigger.hit;
      injected += Number(hit);
    }
  }
  context.diagnostic(`vehicle: ${injected} faults injected, 0 acknowledged frames lost`);
  assert.ok(injected >= 50, `${injected} faults`);
});
