// Jobs, cancels and traps in Node.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { pathToFileURL } from 'node:url';
import { setFlagsFromString } from 'node:v8';
import { runInNewContext } from 'node:vm';
import { generator } from '../lib/build/generator.mjs';
import { root } from '../lib/paths.mjs';

const SAMPLE_MS = 2000;
/** Noise of a heap of this size, bytes, and of a worker that comes a moment later. */
const LEAST = { 'heap bytes': 4e6, 'resident bytes': 4e7, 'array buffer bytes': 8e6, 'handles of the process': 2 };

setFlagsFromString('--expose-gc');
const collect = runInNewContext('gc');

/** Uses a pool for so long; what was done, samples of memory, and what went wrong. */
export async function soakPool({ milliseconds, seed }) {
  const from = (...parts) => import(pathToFileURL(join(root, 'dist', ...parts)).href);
  const boresight = await from('lib', 'node.js');
  const { createPool } = await from('worker', 'node.js');
  const { default: glue } = await from('wasm', 'boresight.js');
  const draw = generator(seed);
  const pick = (list) => list[Math.floor(draw() * list.length)];
  await boresight.init();
  const pool = createPool({ workers: 2 });
  const recording = (name) => readFileSync(join(root, 'recordings', 'awr1642', name));
  const [bin, cfg] = [recording('xwr16xx_crw_dca_module_2018_1015v2.bin'), recording('profile.cfg')];
  const capture = await pool.loadCapture(bin, cfg);
  const scene = { array: 'lrr48', targets: { count: [1, 4] }, snrDb: 20, seed: 3 };
  const { data, shape } = boresight.simulateSnapshots(scene);
  const cell = { data, shape: shape.slice(1) };
  const jobs = {
    estimate: (job) =>
      pool.estimate({ snapshots: cell }, { method: pick(['iaa', 'nomp', 'bartlett']), array: 'lrr48' }, job),
    simulateSnapshots: (job) => pool.simulateSnapshots({ ...scene, scenes: 2000 }, job),
    processFrames: (job) => capture.processFrames({ angle: { method: pick(['bartlett', 'iaa']) } }, job),
    simulateDrive: (job) => pool.simulateDrive({ durationS: 5, seed: 1 }, job),
    imageFrame: (job) => {
      const { waveform, array } = boresight.parseConfig(cfg);
      const cube = boresight.simulateCube({
        waveform,
        array,
        targets: [{ rangeM: 5, azimuthDeg: 0 }],
        snrDb: 20,
        seed: 1,
      });
      return pool.imageFrame(cube, { waveform, array, angle: { method: 'iaa' } }, job);
    },
  };
  const counts = { jobs: 0, cancelled: 0, refused: 0, traps: 0 };
  const series = Object.fromEntries(Object.keys(LEAST).map((name) => [name, []]));
  const problems = [];
  const once = async () => {
    const stop = new AbortController();
    const timer = draw() < 0.3 ? setTimeout(() => stop.abort(), 200 * draw()) : undefined;
    const name = pick(Object.keys(jobs));
    try {
      await jobs[name]({ signal: stop.signal });
      counts.jobs++;
    } catch (error) {
      if (error?.name === 'AbortError') counts.cancelled++;
      else if (error instanceof boresight.BoresightError && error.code !== 'trap') {
        counts.refused++;
        problems.push(`${name}: ${error.message}`);
      } else throw error;
    } finally {
      clearTimeout(timer);
    }
  };
  const trap = async () => {
    const { memory } = await glue();
    new Uint8Array(memory.buffer).fill(0xff);
    try {
      boresight.estimate({ snapshots: cell }, { method: 'iaa', array: 'lrr48' });
      problems.push('a spoilt instance answered');
    } catch {
      counts.traps++;
    }
    await boresight.init();
  };
  const until = performance.now() + milliseconds;
  for (let sampled = 0; performance.now() < until && problems.length < 10; ) {
    await Promise.all([once(), once(), once()]);
    if (draw() < 0.05) await trap();
    if (performance.now() - sampled < SAMPLE_MS) continue;
    sampled = performance.now();
    collect();
    const { heapUsed, rss, arrayBuffers } = process.memoryUsage();
    const handles = process.getActiveResourcesInfo().length;
    const row = [heapUsed, rss, arrayBuffers, handles];
    Object.values(series).forEach((samples, at) => samples.push(row[at]));
  }
  pool.terminate();
  return { counts, series, least: LEAST, problems };
}
