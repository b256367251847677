// A page's end of the bridge, against a server that does what the bridge does, and does it wrong.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { bridgeFrames, Capture, init } from 'boresight';
import { WebSocket, WebSocketServer } from 'ws';
import { startBridge } from '../lib/bridge.mjs';
import { rejectsTyped } from './lib/assert.mjs';
import { bin, cfg } from './lib/recording.mjs';

const FRAME = 131_072;
const hello = {
  type: 'hello',
  version: 1,
  frameBytes: FRAME,
  frameIntervalS: 0.04,
  config: cfg.toString(),
  counts: {},
};
// Node has one of its own since version 22.
globalThis.WebSocket ??= WebSocket;

let server;
let address;
/** What the server does with the next client. */
let serve = () => {};
before(async () => {
  await init();
  server = new WebSocketServer({ host: '127.0.0.1', port: 0 });
  await new Promise((resolve) => server.on('listening', resolve));
  address = `ws://127.0.0.1:${server.address().port}`;
  server.on('connection', (client) => serve(client));
});
after(() => server.close());

function message(number, bytes) {
  const header = Buffer.alloc(8);
  header.writeBigUInt64LE(BigInt(number));
  return Buffer.concat([header, bytes]);
}
const recorded = (k) => bin.subarray(k * FRAME, (k + 1) * FRAME);

test('frames are captures of one frame each', async () => {
  serve = (client) => {
    client.send(JSON.stringify(hello));
    client.send(message(7, recorded(7)));
  };
  const frames = bridgeFrames(address);
  for await (const { number, bytes } of frames) {
    assert.equal(number, 7);
    const capture = new Capture(bytes, frames.hello.config);
    const whole = new Capture(bin, cfg);
    const plain = ({ frame: _, ...detection }) => detection;
    assert.deepEqual(capture.processFrame(0).detections.map(plain), whole.processFrame(7).detections.map(plain));
    capture.free();
    whole.free();
    break;
  }
});

test('a slow reader gets the newest, and what it missed is counted with what the bridge says', async () => {
  const status = {
    type: 'status',
    sentFrames: 9,
    skippedFrames: 3,
    counts: { frames: 12, lostPackets: 2, lostBytes: 2912 },
  };
  serve = (client) => {
    client.send(JSON.stringify(hello));
    for (let k = 0; k < 8; k++) client.send(message(k, recorded(k)));
    client.send(JSON.stringify(status));
  };
  let told;
  const stopping = new AbortController();
  const heard = new Promise((resolve) => {
    told = resolve;
  });
  const frames = bridgeFrames(address, {
    signal: stopping.signal,
    onChange: ({ counts }) => counts.frames === 12 && told(),
  });
  const numbers = [];
  for await (const { number } of frames) {
    await heard;
    numbers.push(number);
    if (number === 7) stopping.abort();
  }
  assert.deepEqual(numbers.slice(-2), [6, 7]);
  assert.equal(frames.skippedFrames, 3 + 8 - numbers.length);
  assert.deepEqual([frames.counts.lostPackets, frames.counts.lostBytes, frames.counts.packets], [2, 2912, 0]);
});

test('what is no bridge, or goes, is told', async () => {
  const all = async (at = address) => {
    for await (const _ of bridgeFrames(at));
  };
  const wrong = {
    'bridge-version': [JSON.stringify({ ...hello, version: 2 })],
    'bridge-frame': [JSON.stringify(hello), message(0, Buffer.alloc(10))],
    'bridge-message': ['hello'],
    'bridge-lost': [JSON.stringify(hello)],
    'bridge-not-reached': [],
  };
  for (const [code, messages] of Object.entries(wrong)) {
    serve = (client) => {
      for (const one of messages) client.send(one);
      if (code === 'bridge-lost' || code === 'bridge-not-reached') client.close(1001, 'the bridge ends');
    };
    await rejectsTyped(all(), code);
  }
  await rejectsTyped(all('http://127.0.0.1:1 '), 'bridge-not-reached');
  await rejectsTyped(all('ws://127.0.0.1:1'), 'bridge-not-reached');
});

test('the bridge of the command line hands a recording on, to pages that may', { timeout: 600_000 }, async () => {
  const bridge = await startBridge('--rate', '2', '--origin', 'https://radar.example');
  const open = (origin) =>
    new Promise((resolve) => {
      const socket = new WebSocket(bridge.address, origin ? { origin } : {});
      socket.on('open', () => socket.close());
      socket.on('unexpected-response', (_, { statusCode }) => resolve(statusCode));
      socket.on('close', () => resolve('open'));
      socket.on('error', () => {});
    });
  for (const [origin, expected] of [
    [undefined, 'open'],
    ['http://localhost:4173', 'open'],
    ['https://radar.example', 'open'],
    ['https://evil.example', 403],
    ['null', 403],
  ])
    assert.equal(await open(origin), expected, origin);
  const frames = bridgeFrames(bridge.address);
  let last = -1;
  let seen = 0;
  for await (const { number, bytes } of frames) {
    assert.ok(number > last);
    last = number;
    assert.ok(Buffer.from(bytes).equals(recorded(number % 8)), `frame ${number}`);
    seen += 1;
    if (seen === 10) break;
  }
  assert.equal(frames.hello.frameBytes, FRAME);
  const { code, counts } = await bridge.end();
  assert.equal(code, 0);
  assert.ok(counts.frames >= 10 && counts.malformed === 0 && counts.restarts === 0, JSON.stringify(counts));
});
