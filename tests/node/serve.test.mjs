/** `boresight serve`, as the client of Foxglove's own package sees it. */
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { once } from 'node:events';
import { createRequire } from 'node:module';
import { test } from 'node:test';
import protocol from '@foxglove/ws-protocol';
import WebSocket from 'ws';
import { root } from '../../scripts/lib/paths.mjs';
import { commandLine } from '../../scripts/lib/programs.mjs';
import { boresight, exported, points } from './lib/exported.mjs';

const { FoxgloveClient } = protocol;
const known = createRequire(import.meta.url)('@foxglove/schemas/jsonschema');
const log = `${root}/recordings/delphi`;
const calibration = ['--min-speed', '3'];
const PROTOCOL = FoxgloveClient.SUPPORTED_SUBPROTOCOL;

/** A server of the recording; its address, and what ends it and gives its counts. */
async function serve(...options) {
  const args = ['serve', log, ...calibration, '--port', '0', '--json', ...options];
  const child = spawn(await commandLine(), args);
  let printed = '';
  child.stdout.on('data', (text) => {
    printed += text;
  });
  const url = await new Promise((resolve, reject) => {
    let told = '';
    child.stderr.on('data', (text) => {
      told += text;
      const found = /serving at (ws:\/\/[^;]+);/.exec(told);
      if (found) resolve(found[1]);
    });
    child.on('exit', (code) => reject(new Error(`ended with ${code}: ${told}`)));
  });
  const end = async () => {
    child.kill('SIGINT');
    const [code] = await once(child, 'exit');
    return { code, counts: JSON.parse(printed) };
  };
  return { url, child, end };
}

/** A client that has been told the channels. */
async function connect(url) {
  const client = new FoxgloveClient({ ws: new WebSocket(url, [PROTOCOL]) });
  const heard = { client, channels: [], statuses: [], errors: [], time: 0n };
  client.on('status', (status) => heard.statuses.push(status));
  client.on('error', (error) => heard.errors.push(error));
  client.on('time', ({ timestamp }) => {
    heard.time = timestamp;
  });
  client.on('serverInfo', (info) => {
    heard.info = info;
  });
  await new Promise((resolve) => {
    client.on('advertise', (channels) => {
      heard.channels = channels;
      resolve();
    });
  });
  return heard;
}

/** Every property of a schema is one of the other, of the same type. */
function within(ours, theirs, path) {
  assert.ok(theirs, path);
  if (ours.oneOf) {
    const named = new Map(theirs.oneOf.map(({ title, const: value }) => [title, value]));
    for (const { title, const: value } of ours.oneOf) assert.equal(named.get(title), value, `${path} ${title}`);
    return;
  }
  assert.equal(ours.type, theirs.type, path);
  assert.equal(ours.contentEncoding, theirs.contentEncoding, path);
  if (ours.type === 'array') within(ours.items, theirs.items, `${path}[]`);
  for (const [name, schema] of Object.entries(ours.properties ?? {})) {
    within(schema, theirs.properties[name], `${path}.${name}`);
  }
}

test("a viewer gets all of a drive's scans with their numbers, and the angle that is calibrated", async () => {
  const [drive, angle] = await Promise.all([
    exported(log),
    boresight('calibrate', log, ...calibration, '--json').then(JSON.parse),
  ]);
  const server = await serve('--rate', '500', '--queue', '1000000');
  try {
    const viewer = await connect(server.url);
    assert.deepEqual(viewer.info.capabilities, ['time', 'parameters', 'parametersSubscribe']);
    const got = new Map();
    const topics = new Map();
    const done = new Promise((resolve) => {
      viewer.client.on('message', ({ subscriptionId, timestamp, data }) => {
        const topic = topics.get(subscriptionId);
        const message = JSON.parse(new TextDecoder().decode(data));
        if (!topic.startsWith('/car/scene') && message.timestamp) {
          const { sec, nsec } = message.timestamp;
          assert.equal(timestamp, BigInt(sec) * 1_000_000_000n + BigInt(nsec));
        }
        got.get(topic).push(message);
        if (topic === '/radar/1/mounting' && message.frames.given === angle.frames.given) resolve();
      });
    });
    for (const { id, topic, encoding, schemaEncoding, schemaName, schema } of viewer.channels) {
      assert.deepEqual([encoding, schemaEncoding], ['json', 'jsonschema']);
      const described = JSON.parse(schema);
      assert.equal(described.title, schemaName);
      const [maker, name] = schemaName.split('.');
      if (maker === 'foxglove') within(described, known[name], schemaName);
      got.set(topic, []);
      topics.set(viewer.client.subscribe(id), topic);
    }
    await done;
    const clouds = got.get('/radar/1/detections');
    const scans = clouds.map(points).filter((scan) => scan.length > 0);
    assert.equal(scans.length, drive.scans.length);
    scans.forEach((scan, k) => assert.deepEqual(scan, drive.scans[k], `scan ${k}`));
    assert.ok(clouds.every(({ frame_id }) => frame_id === 'radar_1'));

    const { timestamp, ...last } = got.get('/radar/1/mounting').at(-1);
    assert.equal(timestamp.sec, 600);
    for (const [name, value] of Object.entries(last)) {
      if (name !== 'driftDeg') assert.deepEqual(value, angle[name], name);
    }
    assert.equal(last.angleDeg, angle.angleDeg);
    assert.equal(last.driftDeg, angle.angleDeg);
    assert.equal(last.alignment, 'misaligned');
    assert.ok(got.get('/log').some(({ level, message }) => level === 3 && message.startsWith('misaligned, ')));
    assert.deepEqual([viewer.statuses, viewer.errors], [[], []]);
    viewer.client.close();
  } finally {
    const { code, counts } = await server.end();
    assert.equal(code, 0);
    assert.deepEqual([counts.clients, counts.lost, counts.refused, counts.rejected], [1, 0, 0, 0]);
  }
});

test('pages from elsewhere are refused, and those that are named are not', async () => {
  const server = await serve('--origin', 'https://viewer.example.com');
  try {
    const answer = (origin) =>
      new Promise((resolve) => {
        const socket = new WebSocket(server.url, [PROTOCOL], { origin });
        socket.on('unexpected-response', (_, response) => resolve(response.statusCode));
        socket.on('open', () => {
          socket.close();
          resolve('open');
        });
        socket.on('error', () => {});
      });
    assert.equal(await answer('https://example.com'), 403);
    for (const origin of [
      'http://localhost:5173',
      'https://app.foxglove.dev',
      'https://viewer.example.com',
      undefined,
    ]) {
      assert.equal(await answer(origin), 'open', origin);
    }
  } finally {
    await server.end();
  }
});
