/** Ends the service by kill -9 while a drive is sent, several times: the digits have to be those of a drive without. */
import assert from 'node:assert/strict';
import { frames, line, RADAR, reference } from './lib/drive.mjs';
import { Service } from './lib/service.mjs';

const BATCH = 16;

/** Sends frames in batches, again where no answer came; `kills` says after which batches the service is ended meanwhile. */
async function drive(service, all, kills) {
  const vehicle = 'car';
  const counts = { killed: 0, repeated: 0, accepted: 0 };
  assert.equal((await service.put(vehicle, 'front', RADAR)).status, 201);
  for (let start = 0; start < all.length; start += BATCH) {
    const body = all
      .slice(start, start + BATCH)
      .map((frame) => line('front', frame))
      .join('');
    if (kills.includes(start / BATCH)) {
      // Some of the batch is kept, and no answer comes.
      const half = new TextEncoder().encode(body);
      const stream = new ReadableStream({
        async start(controller) {
          controller.enqueue(half.subarray(0, Math.round(0.7 * half.length)));
          await new Promise((resolve) => setTimeout(resolve, 300));
          await service.kill();
          controller.close();
        },
      });
      await assert.rejects(service.frames(vehicle, stream));
      counts.killed += 1;
      await service.start();
    }
    const { status, json } = await service.frames(vehicle, body);
    assert.equal(status, 200);
    assert.equal(json.refused, 0, JSON.stringify(json.problems));
    counts.repeated += json.repeated;
    counts.accepted += json.accepted;
  }
  const { json } = await service.about(vehicle);
  const { repeated: _, ...radar } = json.radars[0];
  return { counts, radar };
}

export async function killed(runtime, { durationS = 60, kills = [3, 11, 25], environment } = {}) {
  const all = await frames({ durationS });
  const [whole, cut] = [new Service(runtime, { environment }), new Service(runtime, { environment })];
  try {
    const one = await drive(await whole.start(), all, []);
    const other = await drive(await cut.start(), all, kills);
    assert.equal(other.counts.killed, kills.length);
    assert.ok(other.counts.repeated > 0, 'nothing was kept of what was cut');
    assert.deepEqual(other.radar, one.radar);
    assert.deepEqual(one.radar.result, await reference(all));
    const { angleDeg, sigmaDeg } = one.radar.result;
    return { runtime, frames: all.length, ...other.counts, angleDeg, sigmaDeg };
  } finally {
    await whole.stop();
    await cut.stop();
  }
}
