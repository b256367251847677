/** What the service takes: processor time of a frame, memory of vehicles, and how many vehicles it holds. */
import assert from 'node:assert/strict';
import { once } from 'node:events';
import { createServer } from 'node:net';
import { setTimeout as wait } from 'node:timers/promises';
import { frames, line, RADAR } from './lib/drive.mjs';
import { Service } from './lib/service.mjs';

const FREE = { requests: { perS: 1e9, burst: 1e9 }, frames: { perS: 1e9, burst: 1e9 }, open: 1e6 };
const WARM = 100;
const HZ = 13;

/** Starts the service, does something with it, and stops it. */
async function running(runtime, environment, work, inspector) {
  const service = new Service(runtime, { config: { limits: FREE }, environment, inspector });
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
