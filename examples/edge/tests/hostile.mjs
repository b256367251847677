/**
 * Requests that no honest client sends, while a vehicle of the same tenant drives: the service answers or hangs up, never
 * with an error of its own, and the vehicle's digits are those it has alone.
 */
import assert from 'node:assert/strict';
import { connect } from 'node:net';
import { frames, line, RADAR, reference } from './lib/drive.mjs';
import { randomOf } from './lib/random.mjs';
import { Service, TOKENS } from './lib/service.mjs';

const LIMITS = {
  bodyBytes: 1 << 20,
  lineBytes: 32 << 10,
  idleS: 1,
  requests: { perS: 1e6, burst: 1e6 },
  frames: { perS: 1e6, burst: 1e6 },
};
/** Where bodies go, with their type, as lines of a request. */
const TARGETS = [
  '/v1/vehicles/intruder/frames HTTP/1.1\r\nContent-Type: application/x-ndjson',
  '/v1/estimate HTTP/1.1\r\nContent-Type: application/json',
];
const AUTHORIZED = `Host: x\r\nAuthorization: Bearer ${TOKENS.write}`;
const FRAMES = '/v1/vehicles/intruder/frames';
const JSON_TYPE = { 'content-type': 'application/json' };
const NDJSON = { 'content-type': 'application/x-ndjson' };

const VALUES = [
  null,
  true,
  -1,
  0,
  1e308,
  -1e308,
  5e-324,
  1e21,
  '',
  'NaN',
  '\u0000',
  '🚗'.repeat(50),
  [],
  {},
  [[]],
  [null],
  { length: 1e9 },
];
/** JSON that is none, or that is more than one bargained for. */
const TEXTS = [
  '',
  '{',
  'nul',
  'NaN',
  '[1,]',
  '{"a":1}{"b":2}',
  '\ufeff{}',
  '{"__proto__":{"x":1}}',
  '{"constructor":{"prototype":{"x":1}}}',
  '1e999',
  '-1e999',
  '"\\ud800"',
  '['.repeat(100_000),
  '{"a":'.repeat(50_000),
  `${'['.repeat(20_000)}${']'.repeat(20_000)}`,
  `[${'1,'.repeat(100_000)}1]`,
  `{"a":"${'x'.repeat(200_000)}"}`,
];
const PATHS = [
  '/..',
  '/../../etc/passwd',
  '/%2e%2e/%2e%2e/etc/passwd',
  '/v1/vehicles/%2e%2e',
  '/v1/vehicles/..%2f..%2fvictim',
  '/v1/vehicles/victim%00',
  '/v1/vehicles/victim/../victim%2fframes',
  '/v1/vehicles/%',
  '/v1/vehicles/%ff%fe',
  '/v1/vehicles/%ED%A0%80',
  '/v1/vehicles//frames',
  '//v1//vehicles',
  '/v1/vehicles/victim/',
  '/v1/vehicles/victim;x=1/frames',
  '/v1/vehicles/__proto__',
  '/v1/vehicles/constructor/radars/__proto__',
  '/page/..%2f..%2fconfig.json',
  '/page/../config.json',
  '/page/__proto__',
  '/page/constructor',
  '/config.json',
  '/data/edge.sqlite',
  '/v1/estimate/',
  '/METRICS',
  '/metrics?x=%',
  '/metrics#x',
  '/\\metrics',
  `/${'a'.repeat(6000)}`,
  `/v1/vehicles/${'a'.repeat(65)}`,
  'http://other.example/metrics',
  '*',
];

/** A frame that is nearly right. */
function nearFrame({ one, next, below }) {
  const list = () => Array.from({ length: below(5) }, () => one([next(), 1e308, -0, one(VALUES)]));
  const frame = {
    radar: one(['front', 'front', 'back', 0, one(VALUES)]),
    timeS: one([next() * 100, 1e300, -1e300, -5, one(VALUES)]),
    azimuthDeg: one([list(), list(), one(VALUES)]),
    rangeRateMps: one([list(), list(), one(VALUES)]),
    yawRateDegps: one([0, 1e300, null, one(VALUES)]),
    speedMps: one([0, 1e300, null, one(VALUES)]),
    ...(next() < 0.2 && { [one(['x', '__proto__', 'network', 'toString'])]: one(VALUES) }),
  };
  for (const name of Object.keys(frame)) if (next() < 0.1) delete frame[name];
  return JSON.stringify(frame).replace('5e-324', '1e999');
}

/** Options of a radar, or of an estimate, that are nearly right. */
function nearOptions({ one, next }, fields) {
  const options = Object.fromEntries(fields.map((name) => [name, one([1, 30, 0.5, one(VALUES)])]));
  for (const name of fields) if (next() < 0.4) delete options[name];
  return options;
}

const estimateOf = (random) => {
  const { one, below } = random;
  const lengths = [0, 1, 2, 8, 16, 1e9, -1, 0.5, one(VALUES)];
  return JSON.stringify({
    [one(['snapshots', 'snapshots', 'covariance', 'x'])]: {
      data: one([Array.from({ length: one([0, 16, 20_000]) }, () => one([0.5, 1e308])), one(VALUES)]),
      shape: one([[8, 1], [one(lengths), one(lengths)], Array.from({ length: below(70) }, () => 1), one(VALUES)]),
    },
    options: {
      method: one(['music', 'capon', 'iaa', 'atomic-norm', 'nomp', one(VALUES)]),
      array: one(['ula8', [[0, 1, 2]], Array.from({ length: 3000 }, (_, i) => [0, i, 0]), one(VALUES)]),
      ...nearOptions(random, ['sources', 'gridSize', 'maxPeaks', 'fieldOfViewDeg']),
    },
  });
};

/** Requests by what is wrong with them, each from random numbers: for fetch, or bytes for a socket. */
const KINDS = {
  json: ({ one }) => ({
    path: one(['/v1/estimate', '/v1/calibrate', '/v1/vehicles/intruder/radars/front']),
    method: one(['POST', 'PUT']),
    body: one(TEXTS),
    headers: JSON_TYPE,
  }),
  estimate: (random) => ({ path: '/v1/estimate', method: 'POST', body: estimateOf(random), headers: JSON_TYPE }),
  calibrate: (random) => ({
    path: '/v1/calibrate',
    method: 'POST',
    headers: JSON_TYPE,
    body: `{"options":${JSON.stringify({ method: random.one(['recursive', 'kabsch', 'x']), ...nearOptions(random, ['xM', 'yM', 'nominalDeg', 'memoryS', 'seed']) })},"frames":[${Array.from({ length: random.below(4) }, () => nearFrame(random)).join()}]}`,
  }),
  frames: (random) => ({
    path: FRAMES,
    method: 'POST',
    headers: NDJSON,
    body: Array.from(
      { length: random.below(8) },
      () => `${nearFrame(random)}${random.one(['\n', '\r\n', '\n\n'])}`,
    ).join(''),
  }),
  lines: ({ one, bytes, below }) => ({
    path: FRAMES,
    method: 'POST',
    headers: NDJSON,
    body: one([
      one(TEXTS),
      '\n'.repeat(below(5000)),
      bytes(below(3000)),
      'x'.repeat(100_000),
      '\r',
      '\u2028',
      '{"radar":"front"'.repeat(100),
    ]),
  }),
  options: (random) => ({
    path: `/v1/vehicles/${random.one(['intruder', 'intruder', '%F0%9F%9A%97', 'a%22b%5Cc'])}/radars/${random.one(['front', 'r1', 'r2', '%22', '..', ''])}`,
    method: random.one(['PUT', 'PUT', 'PUT', 'DELETE']),
    headers: JSON_TYPE,
    body: JSON.stringify(
      nearOptions(random, ['xM', 'yM', 'nominalDeg', 'alarmDeg', 'method', 'motion', 'network', 'memoryS', 'zzz']),
    ),
  }),
  tokens: ({ one, bytes }) => ({
    path: one([
      '/v1/vehicles/victim',
      '/v1/vehicles',
      '/metrics',
      '/v1/vehicles/victim/radars/front',
      '/v1/vehicles/victim/frames',
    ]),
    method: one(['GET', 'DELETE', 'POST', 'PUT']),
    body: '{}',
    token: one([
      null,
      'x',
      `${TOKENS.write}x`,
      TOKENS.write.slice(1),
      TOKENS.other,
      'a'.repeat(5000),
      Buffer.from(bytes(40)).toString('base64'),
      `${TOKENS.write} ${TOKENS.write}`,
    ]),
    headers: one([JSON_TYPE, NDJSON, { authorization: 'Basic dGVzdDp0ZXN0' }]),
  }),
  readers: ({ one }) => ({
    path: one([
      '/v1/vehicles/victim',
      '/v1/vehicles/victim/radars/front',
      '/v1/vehicles/victim/frames',
      '/v1/estimate',
    ]),
    method: one(['DELETE', 'POST', 'PUT']),
    body: '{}',
    token: TOKENS.read,
    headers: one([JSON_TYPE, NDJSON]),
  }),
  methods: ({ one }) => ({
    raw: `${one(['PATCH', 'TRACE', 'PROPFIND', 'post', 'OPTIONS', 'HEAD', 'CONNECT', 'X-'])} ${one(['/metrics', '/', FRAMES, '/v1/estimate'])} HTTP/1.1\r\n${AUTHORIZED}\r\nConnection: close\r\n\r\n`,
  }),
  paths: ({ one }) => ({
    raw: `${one(['GET', 'DELETE', 'PUT', 'POST'])} ${one(PATHS)} HTTP/1.1\r\nHost: x\r\nAuthorization: Bearer ${TOKENS.other}\r\nContent-Type: application/json\r\nContent-Length: 2\r\nConnection: close\r\n\r\n{}`,
  }),
  types: ({ one }) => ({
    path: one(['/v1/estimate', '/v1/capture', FRAMES]),
    method: 'POST',
    body: '{}',
    headers: one([
      { 'content-type': 'text/plain' },
      { 'content-type': 'multipart/form-data' },
      { 'content-type': 'multipart/form-data; boundary=' },
      { ...JSON_TYPE, 'content-encoding': 'gzip' },
      { 'content-type': ',;=' },
      { 'content-type': 'x'.repeat(4000) },
    ]),
  }),
  capture: ({ one, bytes, below, next }) => {
    const form = new FormData();
    const config = [
      'sensorStop',
      'channelCfg 15 5 0',
      'profileCfg 0 77 7 7 58 0 0 68 1 256 5500 0 0 30',
      'frameCfg 0 1 32 0 100 1 0',
      one(TEXTS).slice(0, 200),
    ]
      .filter(() => next() < 0.8)
      .join('\n');
    form.set('capture', new Blob([bytes(one([0, 1, 100, 5000]))]), 'x.bin');
    if (next() < 0.9) form.set('config', one([config, new Blob([bytes(100)])]));
    if (next() < 0.5)
      form.set(
        'options',
        one([one(TEXTS).slice(0, 50_000), JSON.stringify({ frame: one(VALUES), cfar: one(VALUES) })]),
      );
    for (let i = below(3); i > 0; i--) form.append('x', 'y');
    return { path: '/v1/capture', method: 'POST', body: form };
  },
  oversized: ({ one }) => ({
    path: one(['/v1/estimate', '/v1/calibrate', '/v1/capture', '/v1/vehicles/intruder/radars/front']),
    method: one(['POST', 'PUT']),
    body: 'x'.repeat(one([70_000, (1 << 20) + 1, 3 << 20])),
    headers: one([JSON_TYPE, { 'content-type': 'multipart/form-data; boundary=x' }]),
  }),
  cut: ({ one, below }) => ({
    raw: `POST ${one(TARGETS)}\r\n${AUTHORIZED}\r\nContent-Length: 5000\r\n\r\n${'{"radar":"front","timeS":1'.repeat(below(100))}`.slice(
      0,
      30 + below(900),
    ),
    cut: true,
  }),
  lengths: ({ one }) => ({
    raw: `POST ${one(TARGETS)}\r\n${AUTHORIZED}\r\n${one(['Content-Length: 1', 'Content-Length: -1', 'Content-Length: x', 'Content-Length: 1e3', 'Content-Length: 2\r\nContent-Length: 30', 'Content-Length: 5\r\nTransfer-Encoding: chunked', 'Transfer-Encoding: chunked', 'Transfer-Encoding: gzip, chunked', 'Content-Length: 99999999999999999999'])}\r\nConnection: close\r\n\r\n${one(['{"a":1}', '5\r\n{"a":\r\nzz\r\n', 'FFFFFFFFFFFFFFFFF\r\nx', '1;x=y\r\n{\r\n0\r\n\r\nGET /metrics HTTP/1.1\r\n\r\n'])}`,
    cut: true,
  }),
  headers: ({ one, bytes }) => ({
    raw: `GET /metrics HTTP/1.1\r\nHost: ${one(['x', '', 'a b', 'x'.repeat(300), '[::1', '../..'])}\r\n${one([`X: ${'y'.repeat(100_000)}`, `Origin: ${'z'.repeat(3000)}`, 'Origin: null', `X-Boresight-Ask: {"action":"forget","tenant":"test","vehicle":"victim"}`, `A${Buffer.from(bytes(5)).toString('latin1')}: 1`, 'X: 1\r\n'.repeat(300).trim(), 'Expect: 100-continue', 'Upgrade: websocket\r\nConnection: Upgrade'])}\r\nAuthorization: Bearer ${TOKENS.other}\r\nConnection: close\r\n\r\n`,
  }),
};

/** What a socket answers to bytes: a status, or that it hung up. `cut` hangs up at this end. */
function raw(url, bytes, cut) {
  const { hostname, port } = new URL(url);
  return new Promise((resolve) => {
    let answer = '';
    const socket = connect(Number(port), hostname, () => {
      socket.write(bytes);
      if (cut) setTimeout(() => socket.destroy(), 30);
    });
    socket.setTimeout(20_000, () => {
      answer ||= 'no answer';
      socket.destroy();
    });
    socket.setEncoding('latin1').on('data', (piece) => (answer += piece));
    socket.on('error', () => {});
    socket.on('close', () =>
      resolve(/^HTTP\/1\.1 (\d+)/.exec(answer)?.[1] ?? (answer === 'no answer' ? answer : 'closed')),
    );
  });
}

/** The status of a request, or that the connection was closed. */
async function statusOf(service, { raw: bytes, cut, path, ...request }) {
  if (bytes !== undefined) return raw(service.url, bytes, cut);
  if (request.method === 'GET') delete request.body;
  try {
    return String((await service.ask(path, { ...request, signal: AbortSignal.timeout(20_000) })).status);
  } catch (error) {
    // Refused before all of it was sent, or never answered.
    return error.name === 'TimeoutError' ? 'no answer' : 'closed';
  }
}

export async function hostile(runtime, { requests = 10_000, seed = 1, atOnce = 8, durationS = 60, environment } = {}) {
  const service = new Service(runtime, { config: { limits: LIMITS }, environment });
  try {
    await service.start();
    const all = await frames({ durationS });
    assert.equal((await service.put('victim', 'front', RADAR)).status, 201);
    assert.equal((await service.put('intruder', 'front', RADAR)).status, 201);
    const names = Object.keys(KINDS);
    const random = randomOf(seed);
    const counts = Object.fromEntries(names.map((name) => [name, {}]));
    let [sent, done, drove] = [0, 0, 0];
    const attack = async () => {
      while (sent < requests) {
        const name = names[sent % names.length];
        sent += 1;
        const given = KINDS[name](random);
        const status = await statusOf(service, given);
        counts[name][status] = (counts[name][status] ?? 0) + 1;
        done += 1;
        const bad = /^5|no answer/.test(status);
        // What a server does not speak is its own answer; workerd has 500 for CONNECT to a worker that takes no sockets.
        const own = runtime === 'workerd' && given.raw?.startsWith('CONNECT') ? '500' : '501';
        if (bad && ![own, '505'].includes(status)) throw new Error(`${name}: ${status}\n${service.errors}`);
      }
    };
    const honest = async () => {
      for (; drove < all.length; drove++) {
        // In step with the attack, so that it lasts as long.
        while (done / requests < drove / all.length) await new Promise((resolve) => setTimeout(resolve, 2));
        const send = () => service.frames('victim', line('front', all[drove]));
        // It shares connections with the attack, and workerd closes those whose bodies it did not read.
        const { status, json } = await send().catch((error) => {
          if (!['EPIPE', 'ECONNRESET', 'UND_ERR_SOCKET'].includes(error.cause?.code)) throw error;
          return send();
        });
        assert.equal(status, 200, JSON.stringify(json));
        assert.equal(json.accepted, 1);
      }
    };
    const stalled = Object.values(TARGETS).map((target) =>
      raw(service.url, `POST ${target}\r\n${AUTHORIZED}\r\nContent-Length: 5000\r\n\r\n{`, false),
    );
    await Promise.all([...Array.from({ length: atOnce }, attack), honest()]);
    assert.deepEqual(await Promise.all(stalled), ['408', '408']);
    const { json } = await service.about('victim');
    const [radar] = json.radars;
    assert.deepEqual(radar.result, await reference(all));
    assert.deepEqual([json.refused, radar.refused, radar.repeated, radar.frames], [{}, {}, 0, all.length]);
    const told = await service.ask('/v1/vehicles');
    assert.ok(told.json.vehicles.some(({ vehicle }) => vehicle === 'victim'));
    return { runtime, requests: done, mostMb: Math.round(service.memory().most / 1e6), counts };
  } finally {
    await service.stop();
  }
}
