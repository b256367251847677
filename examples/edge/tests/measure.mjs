/** What the service takes: processor time of a frame, memory of vehicles, and how many vehicles it holds. */
import assert from 'node:assert/strict';
import { once } from 'node:events';
import { request } from 'node:http';
import { createServer } from 'node:net';
import { setTimeout as wait } from 'node:timers/promises';
import { frames, line, RADAR } from './lib/drive.mjs';
import { Service, TOKENS } from './lib/service.mjs';

const FREE = { requests: { perS: 1e9, burst: 1e9 }, frames: { perS: 1e9, burst: 1e9 }, open: 1e6, streams: 1e6 };
const WARM = 100;
const HZ = 13;

/** Starts the service, does something with it, and stops it. */
async function running(runtime, environment, work, inspector, limits = FREE) {
  const service = new Service(runtime, { config: { limits }, environment, inspector });
  try {
    return await work(await service.start());
  } finally {
    await service.stop();
  }
}

async function freePort() {
  const server = createServer().listen(0, '127.0.0.1');
  await once(server, 'listening');
  const { port } = server.address();
  server.close();
  return port;
}

async function accepted(answer, count) {
  const { status, json } = await answer;
  assert.equal(status, 200, JSON.stringify(json));
  assert.equal(json.accepted, count, JSON.stringify(json.problems));
}

/** A body whose pieces are told when they go. */
const streamed = (pieces) => {
  const encoder = new TextEncoder();
  return new ReadableStream({
    async pull(controller) {
      const { value, done } = await pieces.next();
      if (done) controller.close();
      else controller.enqueue(encoder.encode(value));
    },
  });
};

/** Processor time of a frame, ms: each a request of its own, in one request as it comes, and all sent at once. */
export function cpu(runtime, { detections = 225, durationS = 60, environment } = {}) {
  return running(runtime, environment, async (service) => {
    const all = await frames({ durationS, detections });
    const lines = all.map((frame) => line('front', frame));
    const warm = lines.slice(0, WARM);
    const timed = lines.slice(WARM);
    const ways = {
      async requests(vehicle) {
        for (const one of timed) await accepted(service.frames(vehicle, one), 1);
      },
      async stream(vehicle) {
        async function* paced() {
          for (const one of timed) {
            yield one;
            await wait(4);
          }
        }
        await accepted(service.frames(vehicle, streamed(paced())), timed.length);
      },
      bulk: (vehicle) => accepted(service.frames(vehicle, timed.join('')), timed.length),
    };
    const told = { runtime, detections, frames: timed.length, bytes: Math.round(lines.join('').length / lines.length) };
    for (const [name, way] of Object.entries(ways)) {
      await service.put(name, 'front', RADAR);
      for (const one of warm) await accepted(service.frames(name, one), 1);
      const before = service.cpuMs();
      await way(name);
      told[`${name}Ms`] = Number(((service.cpuMs() - before) / timed.length).toFixed(3));
    }
    return told;
  });
}

/** How long the service takes to come, ms: to listen, and then to its first radar and first estimate, which load the modules. */
export async function startup(runtime, { times = 5, environment } = {}) {
  const took = { listeningMs: [], radarMs: [], estimateMs: [] };
  const data = Array.from({ length: 16 }, (_, i) => (i % 2 ? 0 : 1));
  const body = JSON.stringify({
    snapshots: { data, shape: [8, 1] },
    options: { method: 'bartlett', array: 'ula8', sources: 1 },
  });
  for (let time = 0; time < times; time++) {
    const startMs = performance.now();
    await running(runtime, environment, async (service) => {
      took.listeningMs.push(performance.now() - startMs);
      const timed = async (name, answer) => {
        const askedMs = performance.now();
        assert.ok((await answer()).status < 300);
        took[name].push(performance.now() - askedMs);
      };
      await timed('radarMs', () => service.put('car', 'front', RADAR));
      const headers = { 'content-type': 'application/json' };
      await timed('estimateMs', () => service.ask('/v1/estimate', { method: 'POST', body, headers }));
    });
  }
  const median = (values) => Math.round(values.sort((a, b) => a - b)[Math.floor(values.length / 2)]);
  return { runtime, ...Object.fromEntries(Object.entries(took).map(([name, values]) => [name, median(values)])) };
}

/** Memory with vehicles that all have been driving, MB: of the process before, after, and at most. */
export async function memory(runtime, { vehicles = 100, durationS = 20, detections = 225, environment } = {}) {
  const inspector = runtime === 'workerd' ? await freePort() : undefined;
  return running(
    runtime,
    environment,
    async (service) => {
      const all = await frames({ durationS, detections });
      const lines = all.map((frame) => line('front', frame));
      const body = lines.slice(0, WARM).join('');
      await service.put('first', 'front', RADAR);
      await accepted(service.frames('first', body), WARM);
      const before = service.memory();
      const names = Array.from({ length: vehicles }, (_, i) => `car ${i}`);
      for (const name of names) await service.put(name, 'front', RADAR);
      // In turns of a second, so that all of them stay awake.
      for (let start = 0; start < lines.length; start += HZ) {
        const part = lines.slice(start, start + HZ);
        await Promise.all(names.map((name) => accepted(service.frames(name, part.join('')), part.length)));
      }
      const after = service.memory();
      const mb = (bytes) => Math.round(bytes / 1e6);
      const told = {
        runtime,
        vehicles,
        frames: lines.length,
        beforeMb: mb(before.now),
        afterMb: mb(after.now),
        mostMb: mb(after.most),
      };
      const isolate = inspector && (await service.isolate());
      return { ...told, kbAVehicle: Math.round((after.now - before.now) / 1e3 / vehicles), isolate };
    },
    inspector,
  );
}

/** So many vehicles at 13 Hz, a request a frame: whether all were taken in time, and how long each took. */
export function load(runtime, { vehicles = 40, seconds = 15, detections = 225, environment } = {}) {
  return running(runtime, environment, async (service) => {
    const all = (await frames({ durationS: seconds + 5, detections })).slice(0, HZ * seconds);
    const bodies = all.map((frame) => line('front', frame));
    const names = Array.from({ length: vehicles }, (_, i) => `car ${i}`);
    for (const name of names) await service.put(name, 'front', RADAR);
    const tookMs = [];
    const before = service.cpuMs();
    const startMs = performance.now();
    const drive = async (name, phase) => {
      for (const [i, body] of bodies.entries()) {
        await wait(Math.max(0, startMs + (1000 * (i + phase)) / HZ - performance.now()));
        const sentMs = performance.now();
        await accepted(service.frames(name, body), 1);
        tookMs.push(performance.now() - sentMs);
      }
    };
    await Promise.all(names.map((name, i) => drive(name, i / vehicles)));
    const seconds_ = (performance.now() - startMs) / 1000;
    const cpuMs = service.cpuMs() - before;
    tookMs.sort((a, b) => a - b);
    const quantile = (q) => Number(tookMs[Math.floor(q * (tookMs.length - 1))].toFixed(1));
    const aFrame = cpuMs / tookMs.length;
    return {
      runtime,
      vehicles,
      aSecond: Math.round(tookMs.length / seconds_),
      medianMs: quantile(0.5),
      p99Ms: quantile(0.99),
      cpuMs: Number(aFrame.toFixed(2)),
      cores: Number((cpuMs / 1000 / seconds_).toFixed(2)),
      vehiclesACore: Math.floor(1000 / (HZ * aFrame)),
    };
  });
}

/** How long lists and metrics take while so many vehicles stream, a frame of each every so often: of those that ask, ms. */
export function scrape(runtime, { vehicles = 1000, everyS = 10, seconds = 30, detections = 225, environment } = {}) {
  // The limits of requests at once are the defaults, which are what is tried; the radars are put faster than clients may.
  const limits = { requests: FREE.requests };
  const work = async (service) => {
    const all = await frames({ durationS: 20, detections });
    const lines = all.map((frame) => Buffer.from(line('front', frame)));
    const names = Array.from({ length: vehicles }, (_, i) => `car ${i}`);
    for (let at = 0; at < vehicles; at += 100) {
      const put = await Promise.all(names.slice(at, at + 100).map((name) => service.put(name, 'front', RADAR)));
      for (const { status } of put) assert.equal(status, 201);
    }
    const headers = {
      authorization: `Bearer ${TOKENS.write}`,
      'content-type': 'application/x-ndjson',
      'transfer-encoding': 'chunked',
    };
    const streams = names.map((name) => {
      const path = `/v1/vehicles/${encodeURIComponent(name)}/frames`;
      const sent = request(service.url + path, { method: 'POST', headers, agent: false });
      const answer = once(sent, 'response').then(async ([response]) => {
        response.setEncoding('utf8');
        let text = '';
        for await (const piece of response) text += piece;
        return { status: response.statusCode, json: JSON.parse(text) };
      });
      sent.flushHeaders();
      return { sent, answer, count: 0 };
    });
    const next = (stream) => stream.sent.write(lines[stream.count++]);
    const sending = streams.map((stream, i) => {
      const begin = setTimeout(
        () => {
          next(stream);
          stream.timer = setInterval(next, 1000 * everyS, stream);
        },
        (1000 * everyS * i) / vehicles,
      );
      return () => {
        clearTimeout(begin);
        clearInterval(stream.timer);
      };
    });
    const tookMs = { metrics: [], vehicles: [] };
    const timed = async (name, path) => {
      const askedMs = performance.now();
      const { status, text } = await service.ask(path);
      tookMs[name].push(performance.now() - askedMs);
      assert.equal(status, 200, text.slice(0, 200));
      return text;
    };
    // All stream before it is measured.
    await wait(1000 * everyS);
    const before = service.cpuMs();
    const startMs = performance.now();
    let text = '';
    while (performance.now() - startMs < 1000 * seconds) {
      text = await timed('metrics', '/metrics');
      await timed('vehicles', '/v1/vehicles');
      await wait(500);
    }
    const cores = (service.cpuMs() - before) / (performance.now() - startMs);
    assert.equal(text.match(/^boresight_frames_total/gm)?.length, vehicles);
    for (const stop of sending) stop();
    for (const { sent } of streams) sent.end();
    for (const { answer, count } of streams) await accepted(answer, count);
    const told = (name) => {
      const sorted = tookMs[name].sort((a, b) => a - b);
      const quantile = (q) => Math.round(sorted[Math.floor(q * (sorted.length - 1))]);
      return { [`${name}MedianMs`]: quantile(0.5), [`${name}P95Ms`]: quantile(0.95), [`${name}MostMs`]: quantile(1) };
    };
    return {
      runtime,
      streams: vehicles,
      framesASecond: vehicles / everyS,
      asked: tookMs.metrics.length,
      ...told('metrics'),
      ...told('vehicles'),
      cores: Number(cores.toFixed(2)),
    };
  };
  return running(runtime, environment, work, undefined, limits);
}
