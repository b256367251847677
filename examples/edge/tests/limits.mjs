/** What the service is held to where others misbehave: sockets, bodies, files and processes of the same folder. */
import assert from 'node:assert/strict';
import {
  copyFileSync,
  existsSync,
  mkdirSync,
  readdirSync,
  readFileSync,
  statSync,
  truncateSync,
  writeFileSync,
} from 'node:fs';
import { connect } from 'node:net';
import { join } from 'node:path';
import { setTimeout as wait } from 'node:timers/promises';
import { frames, line, RADAR } from './lib/drive.mjs';
import { Service } from './lib/service.mjs';

/** Does something with a service, and stops it. */
async function running(runtime, { limits = {}, environment }, work) {
  const service = new Service(runtime, { config: { limits }, environment });
  try {
    return await work(await service.start());
  } finally {
    await service.stop();
  }
}

const socketTo = ({ url }) => {
  const { hostname, port } = new URL(url);
  return connect(Number(port), hostname).on('error', () => {});
};

/** When a socket is closed, whatever the reason. */
const closed = (socket) => new Promise((resolve) => socket.once('close', resolve));

/** Asks until it is so. */
async function until(check) {
  while (!(await check())) await wait(10);
}

/** Connections that send nothing, or half of a request, are closed; beyond their limit, the oldest is closed at once. */
async function halfOpen(runtime, environment) {
  if (runtime !== 'node') return undefined;
  const [most, more] = [20, 10];
  return running(runtime, { limits: { idleS: 1, halfOpen: most }, environment }, async (service) => {
    const sockets = Array.from({ length: most + more }, (_, i) => {
      const socket = socketTo(service);
      if (i % 2) socket.write('GET /metrics HTTP/1.1\r\nHost: x\r\n');
      return socket;
    });
    const closing = sockets.map((socket) => closed(socket.resume()));
    await Promise.all(closing.slice(0, more));
    // The connection of who asks takes the place of another one.
    const { status, text } = await service.ask('/metrics');
    assert.equal(status, 200);
    assert.match(text, new RegExp(`^boresight_connections_without_request_total ${more + 1}$`, 'm'));
    assert.match(text, new RegExp(`^boresight_connections_half_open ${most - 1}$`, 'm'));
    await Promise.all(closing);
    const after = await service.ask('/metrics');
    assert.match(after.text, new RegExp(`^boresight_connections_without_request_total ${most + more}$`, 'm'));
    assert.match(after.text, /^boresight_connections_half_open 0$/m);
    return sockets.length;
  });
}

/** Streams of vehicles leave room for other requests. */
function streams(runtime, environment) {
  const most = 8;
  return running(runtime, { limits: { open: 2, streams: most }, environment }, async (service) => {
    const all = await frames({ durationS: 2, detections: 20 });
    assert.equal((await service.put('car', 'front', RADAR)).status, 201);
    const ends = [];
    const answers = Array.from({ length: most }, (_, i) => {
      const body = new ReadableStream({
        start(controller) {
          controller.enqueue(new TextEncoder().encode(line('front', all[i])));
          ends.push(() => controller.close());
        },
      });
      return service.frames('car', body);
    });
    await until(async () => {
      const { radars } = (await service.about('car')).json;
      const refused = Object.values(radars[0].refused).reduce((sum, count) => sum + count, 0);
      return radars[0].frames + refused === most;
    });
    assert.equal((await service.frames('car', line('front', all[most]))).status, 429);
    for (const path of ['/metrics', '/v1/vehicles', '/v1/vehicles/car']) {
      assert.equal((await service.ask(path)).status, 200, path);
    }
    for (const end of ends) end();
    for (const answer of answers) assert.ok([200, 422].includes((await answer).status));
    return most;
  });
}

/** A body after a wrong token is not read. */
function unread(runtime, environment) {
  return running(runtime, { environment }, async (service) => {
    const most = 1 << 28;
    const socket = socketTo(service);
    const piece = Buffer.alloc(1 << 16, 'x');
    let answer = '';
    socket.setEncoding('latin1').on('data', (text) => (answer += text));
    const closing = closed(socket);
    socket.write(
      `POST /v1/estimate HTTP/1.1\r\nHost: x\r\nAuthorization: Bearer wrong\r\nContent-Length: ${2 * most}\r\n\r\n`,
    );
    const send = () => {
      while (!socket.destroyed && socket.bytesWritten < most && socket.write(piece));
      if (socket.bytesWritten >= most) socket.destroy();
    };
    socket.on('drain', send);
    send();
    await closing;
    assert.match(answer, /^HTTP\/1\.1 401 /);
    assert.match(answer, /^connection: close\r$/im);
    assert.ok(socket.bytesWritten < most / 4, `${socket.bytesWritten} bytes were read`);
    // A small one is, and the connection goes on.
    const small = await service.ask('/v1/estimate', { method: 'POST', body: '{}', token: 'wrong' });
    assert.deepEqual([small.status, small.headers.get('connection') === 'close'], [401, false]);
    return socket.bytesWritten;
  });
}

/** A second process on the same folder does not start, and says who has it; one after a killed process does. */
function lock(runtime, environment) {
  if (runtime === 'workerd') return undefined;
  return running(runtime, { environment }, async (first) => {
    const second = new Service(runtime, { environment: { ...environment, DATA: first.data } });
    try {
      await assert.rejects(second.start(), new RegExp(`is in use by process ${first.pid} on `));
      await first.kill();
      await second.start();
      await second.kill();
      // Many at once: one of them starts.
      const many = Array.from(
        { length: 4 },
        () => new Service(runtime, { environment: { ...environment, DATA: first.data } }),
      );
      const started = await Promise.allSettled(many.map((one) => one.start()));
      const holders = started.filter(({ status }) => status === 'fulfilled');
      for (const one of many) await one.stop();
      assert.equal(holders.length, 1);
      for (const { reason } of started) if (reason) assert.match(String(reason), /is in use by process \d+ on /);
    } finally {
      await second.stop();
    }
    return 6;
  });
}

/** Files that cannot be read: the service starts, says which, and everything else works; nothing is deleted. */
function quarantine(runtime, environment) {
  return running(runtime, { environment }, async (service) => {
    const folder = join(service.data, 'files');
    if (!existsSync(folder)) return undefined;
    const all = await frames({ durationS: 2, detections: 20 });
    const body = all.map((frame) => line('front', frame)).join('');
    const fileOf = new Map();
    for (const name of ['bad', 'good']) {
      const before = new Set(readdirSync(folder));
      await service.put(name, 'front', RADAR);
      const { json } = await service.frames(name, body);
      assert.equal(json.accepted, all.length);
      const added = readdirSync(folder).filter((file) => !before.has(file));
      const isOf = (file) => readFileSync(join(folder, file)).includes(`vehicle/test/${name}"`);
      fileOf.set(name, join(folder, added.find(isOf)));
    }
    await service.kill();
    const whole = readFileSync(fileOf.get('bad'));
    truncateSync(fileOf.get('bad'), whole.length >> 1);
    mkdirSync(join(folder, `${'0'.repeat(64)}.kept`));
    mkdirSync(join(folder, `${'1'.repeat(64)}.kept.new`));
    writeFileSync(join(folder, 'notes.txt'), 'mine');
    copyFileSync(fileOf.get('good'), join(folder, `${'2'.repeat(64)}.kept`));
    const entries = () => readdirSync(folder).map((name) => [name, statSync(join(folder, name)).size]);
    const before = entries();

    await service.start();
    const { json: health } = await service.ask('/health');
    assert.deepEqual(health, { ok: true, quarantined: 1, unreadableEntries: 5 });
    assert.match(service.errors, /vehicle bad of tenant test: .*\.kept: .* bytes/);
    assert.match(service.errors, /notes\.txt cannot be read/);
    for (const answer of [
      service.about('bad'),
      service.frames('bad', body),
      service.put('bad', 'front', RADAR),
      service.ask('/v1/vehicles/bad', { method: 'DELETE' }),
    ]) {
      const { status, json } = await answer;
      assert.deepEqual([status, json.code], [503, 'quarantined']);
    }
    assert.equal((await service.frames('good', body)).json.repeated, all.length);
    const { text } = await service.ask('/metrics');
    assert.match(text, /^boresight_quarantined\{vehicle="bad"\} 1$/m);
    assert.match(text, /^boresight_quarantined\{vehicle="good"\} 0$/m);
    const others = ([name]) => !fileOf.get('good').endsWith(name) && before.some(([known]) => known === name);
    const sizes = new Map(entries());
    for (const [name, size] of before.filter(others)) {
      if (readFileIs(join(folder, name), 'fleet/')) continue;
      assert.equal(sizes.get(name), size, name);
    }

    // Restored from elsewhere, it is taken again.
    writeFileSync(fileOf.get('bad'), whole);
    assert.equal((await service.frames('bad', body)).json.repeated, all.length);
    assert.equal((await service.ask('/health')).json.quarantined, 0);
    return before.length;
  });
}

/** Whether a file has this text. */
const readFileIs = (path, text) => statSync(path).isFile() && readFileSync(path).includes(text);

const PARTS = { halfOpen, streams, unread, lock, quarantine };

/** What each part counted; nothing where it is not for this runtime. */
export async function limits(runtime, { parts = Object.keys(PARTS), environment } = {}) {
  const told = { runtime };
  for (const part of parts) told[part] = await PARTS[part](runtime, environment);
  return told;
}
