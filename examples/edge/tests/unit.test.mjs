/** The parts of the service, and a vehicle on a storage in memory that can fail. */
import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { existsSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { Calibration, initDrives } from 'boresight';
import { Bucket } from '../src/bucket.js';
import { configOf } from '../src/config.js';
import { Fleet } from '../src/fleet.js';
import { digestOf, frameOf, isName } from '../src/frame.js';
import { handlerOf } from '../src/handler.js';
import { History } from '../src/history.js';
import { Lines } from '../src/lines.js';
import { openMetrics } from '../src/metrics.js';
import { Recent } from '../src/recent.js';
import { wrongType } from '../src/reply.js';
import { openFiles } from '../src/storage/files.js';
import { pack, unpack } from '../src/storage/pack.js';
import { openSqlite } from '../src/storage/sqlite.js';
import { together } from '../src/storage/together.js';
import { Vehicle } from '../src/vehicle.js';
import { frames, line, RADAR, reference } from './lib/drive.mjs';

const bytes = (text) => new TextEncoder().encode(text);
const text = (given) => new TextDecoder().decode(given);

test('lines are the same wherever a text is cut; long ones are left out by number', () => {
  const whole = bytes(`a\n\nbcd\n${'x'.repeat(50)}\n${'y'.repeat(20)}\nend`);
  for (let size = 1; size <= whole.length; size++) {
    const lines = new Lines(20);
    const found = [];
    for (let at = 0; at < whole.length; at += size) found.push(...lines.push(whole.subarray(at, at + size)));
    found.push(...lines.end());
    const told = found.map(({ number, bytes }) => [number, bytes && text(bytes)]);
    assert.deepEqual(told, [
      [1, 'a'],
      [2, ''],
      [3, 'bcd'],
      [4, undefined],
      [5, 'y'.repeat(20)],
      [6, 'end'],
    ]);
  }
});

test('a bucket lets a burst through, then its rate, and says when to come again', () => {
  const bucket = new Bucket({ perS: 2, burst: 3 }, 0);
  for (let i = 0; i < 3; i++) bucket.take(1, 0, 'x');
  assert.throws(() => bucket.take(1, 0, 'x'), { status: 429, headers: { 'retry-after': '1' } });
  bucket.take(1, 500, 'x');
  assert.throws(() => bucket.take(1, 500, 'x'), { code: 'too-many-requests' });
  // What is more than there is, is owed.
  bucket.take(10, 2000, 'x');
  assert.throws(() => bucket.take(1, 4000, 'x'), { headers: { 'retry-after': '2' } });
  // A clock that runs backwards gives nothing.
  assert.throws(() => bucket.take(1, 0, 'x'));
});

test('settings have defaults, and are refused where they are not settings', () => {
  const { limits, retentionDays } = configOf('{"tenants":{},"limits":{"open":7}}');
  assert.deepEqual([limits.open, limits.radars, retentionDays], [7, 16, 30]);
  const token = { sha256: 'a'.repeat(64), role: 'read' };
  configOf({ tenants: { a: { tokens: [token] } } });
  for (const [given, message] of [
    [{ limit: {} }, /config.limit is not a setting/],
    [{ limits: { open: -1 } }, /config.limits.open is a number greater than 0/],
    [{ origins: 'x' }, /config.origins is a list/],
    [{ tenants: { 'A B': { tokens: [] } } }, /small letters/],
    [{ tenants: { a: { tokens: [{ ...token, sha256: 'secret' }] } } }, /64 hexadecimal/],
    [{ tenants: { a: { tokens: [{ ...token, role: 'admin' }] } } }, /read or write/],
  ]) {
    assert.throws(() => configOf(given), message);
  }
});

test('names are of any script, without what paths and labels trip over', () => {
  for (const name of ['WVWZZZ1JZXW000001', 'Prüfstand 3', '車両', 'a"b\\c', 'x'.repeat(64), '__proto__'])
    assert.ok(isName(name), name);
  for (const name of ['', '.', '..', 'a/b', 'a\nb', '\u0000', '\ud800', '\u2028', 'x'.repeat(65)])
    assert.ok(!isName(name), name);
});

test('a frame of other fields or types is refused, and says which', () => {
  const right = { radar: 1, timeS: 0, azimuthDeg: [1], rangeRateMps: [2], yawRateDegps: null };
  assert.equal(frameOf(right, { detections: 5 }).radar, '1');
  for (const [change, what] of [
    [{ timeS: '0' }, 'frame.timeS'],
    [{ azimuthDeg: [1, null] }, 'frame.azimuthDeg[1]'],
    [{ azimuthDeg: { length: 1e9 } }, 'frame.azimuthDeg'],
    [{ rangeRateMps: [1, 2, 3, 4, 5, 6] }, 'frame.rangeRateMps'],
    [{ yawRateDegps: undefined }, 'frame.yawRateDegps'],
    [{ speedMps: true }, 'frame.speedMps'],
    [{ rangeM: [1] }, 'frame.rangeM'],
  ]) {
    assert.throws(
      () => frameOf({ ...right, ...change }, { detections: 5 }),
      ({ status, details }) => status === 422 && details.what === what,
    );
  }
});

test('digests differ where any number does', () => {
  const frame = (change) => {
    const { frame } = frameOf(
      { radar: 1, timeS: 1, azimuthDeg: [1, 2], rangeRateMps: [3, 4], yawRateDegps: 5, ...change },
      { detections: 9 },
    );
    return digestOf(frame).join();
  };
  const all = [
    {},
    { timeS: 2 },
    { azimuthDeg: [2, 1] },
    { azimuthDeg: [1, 2 + 1e-15] },
    { rangeRateMps: [3, -4] },
    { yawRateDegps: null },
    { speedMps: 0 },
  ];
  assert.equal(new Set(all.map(frame)).size, all.length);
  assert.equal(frame({}), frame({}));
});

test('the last frames are known again, after being kept too', () => {
  const recent = new Recent();
  for (let i = 0; i < 3000; i++) recent.add(i, [i, 2 * i]);
  const kept = new Recent(recent.head, ...recent.parts.map((part) => new Uint8Array(part)));
  for (const one of [recent, kept]) {
    assert.ok(one.has(2999, [2999, 5998]) && one.has(2000, [2000, 4000]));
    assert.ok(!one.has(2999, [2999, 0]) && !one.has(100, [100, 200]));
  }
});

test('a history stays bounded and reaches back to the beginning', () => {
  const history = new History();
  for (let timeS = 0; timeS < 100_000; timeS++) {
    if (history.due(timeS)) history.add(timeS, { angleDeg: timeS / 1000, sigmaDeg: 1 });
  }
  const { timeS, angleDeg } = history.toJSON();
  assert.ok(timeS.length > 400 && timeS.length <= 1024, `${timeS.length} points`);
  assert.equal(timeS[0], 0);
  assert.ok(timeS.at(-1) > 99_000);
  const gaps = timeS.slice(1).map((time, i) => time - timeS[i]);
  assert.ok(Math.max(...gaps) <= 2 * Math.min(...gaps), 'evenly');
  assert.ok(timeS.every((time, i) => angleDeg[i] === time / 1000 && !(time <= timeS[i - 1])));
});

test('labels are escaped, and no deviation is infinite', () => {
  const radar = {
    radar: 'a"b\\c',
    angleDeg: 1.5,
    sigmaDeg: null,
    nominalDeg: null,
    alarmDeg: 1,
    misaligned: null,
    alignment: null,
    timeS: null,
    frames: 1,
    detections: 2,
    repeated: 0,
    stale: true,
    clockResets: 2,
    rejectedDetections: 5,
    refused: { shape: 3 },
    verdicts: { given: 1, used: 1 },
  };
  const told = openMetrics([{ vehicle: 'line\nbreak', receivedMs: 1500, refused: {}, radars: [radar] }]);
  const labels = 'vehicle="line\\nbreak",radar="a\\"b\\\\c"';
  for (const expected of [
    `boresight_mounting_angle_degrees{${labels}} 1.5`,
    `boresight_mounting_angle_sigma_degrees{${labels}} +Inf`,
    `boresight_frames_refused_total{${labels},reason="shape"} 3`,
    `boresight_stale{${labels}} 1`,
    `boresight_clock_resets_total{${labels}} 2`,
    `boresight_detections_rejected_total{${labels}} 5`,
    'boresight_received_timestamp_seconds{vehicle="line\\nbreak"} 1.5',
    '# UNIT boresight_mounting_angle_degrees degrees',
  ]) {
    assert.ok(told.includes(`${expected}\n`), expected);
  }
  assert.ok(!told.includes('boresight_misaligned{'), 'without a nominal angle');
  assert.ok(told.endsWith('\n# EOF\n'));
});

test('writes that come together are kept together, and fail together', async () => {
  const commits = [];
  const write = together((writes) => {
    commits.push(writes);
    if (writes.includes('bad')) throw new Error('full');
  });
  await Promise.all([write(1), write(2)]);
  await write(3);
  const results = await Promise.allSettled([write('bad'), write(4)]);
  await write(5);
  assert.deepEqual(commits, [[1, 2], [3], ['bad', 4], [5]]);
  assert.deepEqual(
    results.map(({ status }) => status),
    ['rejected', 'rejected'],
  );
});

for (const [kind, open] of [
  ['files', (folder) => openFiles(join(folder, 'files'))],
  ['sqlite', (folder) => openSqlite(join(folder, 'edge.sqlite'))],
]) {
  test(`${kind}: what was written is there when opened again`, async (context) => {
    const folder = mkdtempSync(join(tmpdir(), 'boresight-edge-'));
    try {
      const database = await open(folder);
      if (!database) return context.skip('this runtime has no SQLite');
      const one = database.open('a/1');
      assert.equal(one.read().size, 0);
      await one.write([
        ['x', bytes('1')],
        ['y', bytes('2')],
      ]);
      await one.write([
        ['x', null],
        ['z', new Uint8Array(100_000).fill(7)],
      ]);
      await database.open('a/2').write([['x', bytes('other')]]);
      await one.setAlarm(5);
      const again = await open(folder);
      const read = again.open('a/1').read();
      assert.deepEqual([...read.keys()].sort(), ['y', 'z']);
      assert.equal(text(read.get('y')), '2');
      assert.equal(read.get('z').length, 100_000);
      assert.equal(await again.open('a/1').alarm(), 5);
      assert.deepEqual(
        again.alarms().map(({ name, atMs }) => [name, atMs]),
        [['a/1', 5]],
      );
      await again.open('a/1').clear();
      const last = await open(folder);
      assert.deepEqual([last.open('a/1').read().size, last.alarms().length], [0, 0]);
      assert.equal(text(last.open('a/2').read().get('x')), 'other');
      if (kind === 'files') {
        // What a killed process had begun to write.
        const begun = join(folder, 'files', `${'a'.repeat(64)}.kept.new`);
        writeFileSync(begun, 'half');
        // What is not the service's stays.
        const notes = join(folder, 'files', 'notes.txt');
        writeFileSync(notes, 'mine');
        const { unreadable } = await open(folder);
        assert.deepEqual([existsSync(begun), existsSync(notes), [...unreadable.keys()]], [false, true, ['notes.txt']]);
      }
    } finally {
      rmSync(folder, { recursive: true, force: true });
    }
  });
}

/** A vehicle whose storage fails when told to, and whose clock is set. */
function vehicle(limits = {}) {
  const kept = new Map();
  const state = { fails: false, nowMs: 1e12, alarmMs: null, told: [], quarantined: [], forgotten: 0 };
  const storage = {
    read: () => new Map(kept),
    write(changes) {
      if (state.fails) throw new Error('the disk is full');
      for (const [key, value] of changes) value ? kept.set(key, value.slice()) : kept.delete(key);
    },
    clear() {
      if (state.fails) throw new Error('the disk is full');
      kept.clear();
      state.alarmMs = null;
    },
    alarm: () => state.alarmMs,
    setAlarm(atMs) {
      state.alarmMs = atMs;
    },
  };
  const fleet = {
    admit: async () => true,
    tell: (_, told) => void state.told.push(told),
    quarantine: async (name, code) => void state.quarantined.push([name, code]),
    forget: async () => Boolean(++state.forgotten),
  };
  const config = configOf({ tenants: {}, retentionDays: 1, limits });
  const make = () =>
    new Vehicle(
      storage,
      config,
      () => fleet,
      () => state.nowMs,
    );
  let live = make();
  const ask = async (action, method, body, type, radar) => {
    const headers = { 'content-type': type, ...(body && { 'content-length': String(bytes(body).length) }) };
    const request = new Request('https://vehicle/', { method, ...(body && { body }), headers });
    const answer = await live.answer({ tenant: 'test', vehicle: 'car', action, radar }, request);
    return { status: answer.status, json: answer.status === 204 ? null : await answer.json() };
  };
  return {
    state,
    kept,
    put: (options = RADAR) => ask('configure', 'PUT', JSON.stringify(options), 'application/json', 'front'),
    take: (...all) => ask('take', 'POST', all.map((frame) => line('front', frame)).join(''), 'application/x-ndjson'),
    send: (body) => ask('take', 'POST', body, 'application/x-ndjson'),
    about: () => ask('describe', 'GET'),
    forget: () => ask('forget', 'DELETE'),
    forgetRadar: () => ask('forgetRadar', 'DELETE', undefined, undefined, 'front'),
    alarm: () => live.alarm(),
    /** As a process that was killed and started anew. */
    restart: () => (live = make()),
  };
}

await initDrives();
const all = await frames({ durationS: 8 });

test('what no storage took is not acknowledged, and is taken once when it comes again', async (context) => {
  context.mock.method(console, 'error', () => {});
  const { put, take, about, state, restart } = vehicle();
  state.fails = true;
  assert.equal((await put()).status, 503);
  assert.equal((await about()).status, 404);
  assert.deepEqual(state.told, [], 'no fleet lists it');
  state.fails = false;
  // The radar is there, and is kept now.
  assert.equal((await put()).status, 200);
  restart();
  assert.equal((await about()).json.radars.length, 1);
  assert.equal((await take(...all.slice(0, 30))).json.accepted, 30);
  state.fails = true;
  const refused = await take(...all.slice(30, 60));
  assert.deepEqual([refused.status, refused.json.code, refused.json.stored.accepted], [503, 'not-stored', 0]);
  state.fails = false;
  assert.equal((await take(...all.slice(30, 60))).json.repeated, 30);
  const { history } = (await about()).json.radars[0];
  restart();
  assert.deepEqual((await about()).json.radars[0].history, history);
  assert.equal((await take(...all.slice(60))).json.accepted, all.length - 60);
  assert.deepEqual((await about()).json.radars[0].result, await reference(all));
});

test('frames out of order, far ahead or of no radar are refused and counted, and leave no trace', async () => {
  const { put, take, about } = vehicle();
  await put();
  await take(...all.slice(0, 50));
  const [frame] = all;
  const { status, json } = await take(
    { ...frame, timeS: frame.timeS + 0.001 },
    { ...frame, timeS: 1e300 },
    { ...frame, timeS: 1e10 },
  );
  assert.equal(status, 422);
  assert.deepEqual(
    json.problems.map(({ line, code }) => [line, code]),
    [
      [1, 'time-backwards'],
      [2, 'out-of-range'],
      [3, 'time-ahead'],
    ],
  );
  const { radars } = (await about()).json;
  assert.deepEqual(radars[0].refused, { 'time-backwards': 1, 'out-of-range': 1, 'time-ahead': 1 });
  assert.deepEqual(radars[0].result, { ...(await reference(all.slice(0, 50))), rejectedFrames: 1 });
});

test('a radar whose clock was reset starts a session after ten frames, also across a restart of the service', async () => {
  const { put, take, about, restart } = vehicle();
  await put();
  const before = all.map((frame) => ({ ...frame, timeS: frame.timeS + 4294.967296 }));
  await take(...before);
  await take(...all.slice(0, 5));
  const stale = (await about()).json.radars[0];
  assert.deepEqual([stale.stale, stale.clockResets, stale.refused], [true, 0, { 'time-backwards': 5 }]);
  restart();
  await take(...all.slice(5));
  const radar = (await about()).json.radars[0];
  assert.deepEqual([radar.stale, radar.clockResets, radar.refused], [false, 1, { 'time-backwards': 9 }]);
  assert.equal(radar.frames, 2 * all.length - 9);
  assert.equal(radar.timeS, all.at(-1).timeS);
  assert.equal(radar.history.timeS.at(-1) < before[0].timeS, true);
  // What is sent again counts once.
  assert.equal((await take(...all.slice(-20))).json.repeated, 20);
});

test('a radar keeps its options until it is forgotten', async () => {
  const { put, take, about, forgetRadar } = vehicle();
  assert.equal((await put()).status, 201);
  await take(...all.slice(0, 20));
  assert.equal((await put()).status, 200);
  const other = await put({ ...RADAR, nominalDeg: 10 });
  assert.deepEqual([other.status, other.json.code], [409, 'exists']);
  assert.equal((await put({ ...RADAR, method: 'kabsch' })).json.code, 'unsuited-method');
  assert.equal((await put({ ...RADAR, xM: 1e9 })).status, 422);
  assert.equal((await forgetRadar()).status, 204);
  assert.deepEqual((await about()).json.radars, []);
  assert.equal((await put({ ...RADAR, nominalDeg: 10 })).status, 201);
});

test('a fleet is told every five seconds, and of the end by an alarm; then a vehicle is forgotten', async () => {
  const { put, take, about, alarm, state, kept } = vehicle();
  await put();
  for (const [i, frame] of all.entries()) {
    state.nowMs = 1e12 + 100 * i;
    await take(frame);
  }
  assert.ok(state.told.length >= 2 && state.told.length <= 4, `${state.told.length} times`);
  assert.ok(state.told.at(-1).radars[0].frames < all.length);
  state.nowMs = state.alarmMs;
  await alarm();
  assert.equal(state.told.at(-1).radars[0].frames, all.length);
  state.nowMs = state.alarmMs;
  await alarm();
  assert.deepEqual([state.forgotten, kept.size], [1, 0]);
  assert.equal((await about()).status, 404);
});

test('what no storage forgets is still there, and is forgotten when it is asked again', async (context) => {
  context.mock.method(console, 'error', () => {});
  const { put, take, about, forget, forgetRadar, state, restart } = vehicle();
  await put();
  await take(...all.slice(0, 30));
  state.fails = true;
  for (const answer of [await forgetRadar(), await forget()]) {
    assert.deepEqual([answer.status, answer.json.code], [503, 'not-stored']);
    assert.equal((await about()).json.radars[0].frames, 30);
  }
  state.fails = false;
  assert.equal((await take(...all.slice(30, 60))).json.accepted, 30);
  restart();
  assert.equal((await about()).json.radars[0].frames, 60);
  assert.equal((await forgetRadar()).status, 204);
  assert.equal((await forget()).status, 204);
  assert.equal((await about()).status, 404);
});

test('a full disk is answered with 503, and nothing is listed that is not stored', async (context) => {
  context.mock.method(console, 'error', () => {});
  const disk = { full: true, kept: new Map() };
  const storageOf = (name) => ({
    read: () => new Map(disk.kept.get(name)),
    async write(changes) {
      if (disk.full) throw Object.assign(new Error('no space left on device'), { code: 'ENOSPC' });
      disk.kept.set(name, new Map([...(disk.kept.get(name) ?? []), ...changes]));
    },
    clear: () => disk.kept.delete(name),
    alarm: () => null,
    setAlarm: async () => {},
  });
  const sha256 = createHash('sha256').update('w').digest('hex');
  const config = configOf({ tenants: { test: { tokens: [{ sha256, role: 'write' }], vehicles: 2 } } });
  const fleet = new Fleet(storageOf('fleet'));
  const vehicles = new Map();
  const handler = handlerOf({
    config,
    vehicle: (ask, request) => {
      const made = vehicles.get(ask.vehicle) ?? new Vehicle(storageOf(ask.vehicle), config, () => fleet);
      vehicles.set(ask.vehicle, made);
      return made.answer(ask, request);
    },
    vehicles: async () => fleet.vehicles(),
    page: () => new Response(),
  });
  const ask = async (path, method, body) => {
    const headers = {
      authorization: 'Bearer w',
      'content-type': 'application/json',
      'content-length': `${body?.length}`,
    };
    const answer = await handler(new Request(`http://edge${path}`, { method, headers, body }));
    return { status: answer.status, json: await answer.json() };
  };
  const put = (name) => ask(`/v1/vehicles/${name}/radars/front`, 'PUT', JSON.stringify(RADAR));
  const listed = async () => (await ask('/v1/vehicles', 'GET')).json.vehicles.map(({ vehicle }) => vehicle);
  assert.deepEqual([(await put('a')).json.code, (await put('b')).status], ['not-stored', 503]);
  assert.deepEqual(await listed(), []);
  disk.full = false;
  assert.deepEqual([(await put('a')).status, (await put('b')).status], [200, 200]);
  assert.deepEqual(await listed(), ['a', 'b']);
  // Places are counted whether they are listed yet or not.
  assert.equal((await put('c')).status, 409);
});

test('packed bytes that changed anywhere are recognised; those of versions without a checksum are read', () => {
  const given = [{ a: [1, null, 'ä'] }, bytes('part'), new Uint8Array(), bytes('odd')];
  const packed = pack(...given);
  assert.deepEqual(unpack(packed), given);
  const shifted = new Uint8Array(packed.length + 1);
  shifted.set(packed, 1);
  assert.deepEqual(unpack(shifted.subarray(1)), given);
  for (let at = 0; at < packed.length; at++) {
    for (let bit = 0; bit < 8; bit++) {
      const changed = packed.slice();
      changed[at] ^= 1 << bit;
      assert.throws(() => unpack(changed), `bit ${bit} of byte ${at}`);
    }
    assert.throws(() => unpack(packed.subarray(0, at)), `the first ${at} bytes`);
    assert.throws(() => unpack(packed.slice().fill(0, at)), `zeros from byte ${at} on`);
  }
  assert.deepEqual(unpack(packed.subarray(12)), given);
});

test('a vehicle whose stored data is damaged is quarantined: it answers 503, and nothing is written over it', async (context) => {
  context.mock.method(console, 'error', () => {});
  for (const key of ['vehicle', 'radar/front', 'history/front']) {
    const { put, take, about, forget, alarm, kept, restart, state } = vehicle();
    await put();
    await take(...all.slice(0, 60));
    const whole = kept.get(key);
    // The times and digests of the last frames are at the end, counts at the beginning.
    for (const at of [whole.length - 9, 40]) {
      const damaged = whole.slice();
      damaged[at] ^= 1;
      kept.set(key, damaged);
      restart();
      for (const answer of [await about(), await take(...all), await put(), await forget()]) {
        assert.deepEqual([answer.status, answer.json.code], [503, 'quarantined'], `${key}, byte ${at}`);
      }
      await alarm();
      assert.equal(kept.get(key), damaged);
    }
    assert.deepEqual(state.quarantined[0], ['car', 'quarantined']);
    kept.set(key, whole);
    assert.equal((await about()).json.radars[0].frames, 60);
  }
});

test('a snapshot of a newer version is quarantined under its own code, and is taken again by a service that reads it', async (context) => {
  context.mock.method(console, 'error', () => {});
  const { put, take, about, kept, restart, state } = vehicle();
  await put();
  await take(...all.slice(0, 60));
  const stored = new Map(kept);
  const newer = Object.assign(new Error('the snapshot has version 9; expected 3 at most'), {
    name: 'BoresightError',
    code: 'unsupported-snapshot',
  });
  const restore = context.mock.method(Calibration, 'restore', () => {
    throw newer;
  });
  restart();
  for (const answer of [await about(), await take(...all)]) {
    assert.deepEqual([answer.status, answer.json.code], [503, 'unsupported-snapshot']);
    assert.match(answer.json.message, /version 9; expected 3 at most/);
  }
  assert.deepEqual(state.quarantined, [['car', 'unsupported-snapshot']]);
  assert.deepEqual(kept, stored);
  restore.mock.restore();
  assert.equal((await take(...all)).json.repeated, 60);
  assert.deepEqual((await about()).json.radars[0].result, await reference(all));
});

test('blank lines cost no frames', async () => {
  const { put, send } = vehicle({ frames: { perS: 1, burst: 2 } });
  await put();
  const blank = ['\n', '\r\n', ' \t\n'].join('').repeat(500);
  const sent = await send(blank + line('front', all[0]) + blank + line('front', all[1]) + blank);
  assert.deepEqual([sent.status, sent.json.accepted, sent.json.refused], [200, 2, 0]);
  assert.equal((await send(blank)).status, 200);
  assert.equal((await send(line('front', all[2]))).json.code, 'too-many-requests');
});

test('a wrong type is named', () => {
  for (const [given, message] of [
    [[], 'the body is an array; expected an object'],
    [null, 'the body is null; expected an object'],
    ['x', 'the body is a string; expected an object'],
    [undefined, 'the body is missing; expected an object'],
  ]) {
    assert.equal(wrongType('the body', 'an object', given).message, message);
  }
});
