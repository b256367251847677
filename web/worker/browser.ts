// Entry for browsers and bundlers.
import { Pool } from './api.js';
import { browserRuntime } from './browser-runtime.js';
import type { PoolOptions } from './options.js';

export * from './exports.js';

const runtime = browserRuntime({
  packaged: () => ({
    core: new URL('../wasm/boresight_bg.wasm', import.meta.url),
    drives: new URL('../wasm/boresight_drives_bg.wasm', import.meta.url),
  }),
  start: () => new Worker(new URL('./browser-worker.js', import.meta.url), { type: 'module' }),
});

/**
 * Makes a pool of module workers.
 *
 * @example
 * ```js
 * import { createPool } from 'boresight/worker';
 *
 * const pool = createPool({ workers: 2 });
 * const scene = { array: 'lrr48', targets: { count: [1, 4] }, snrDb: 20, scenes: 500, seed: 7 };
 * const { shape } = await pool.simulateSnapshots(scene, { signal: AbortSignal.timeout(60_000) });
 * pool.terminate();
 * console.log(shape); // → [ 500, 48, 1 ]
 * ```
 */
export function createPool(options?: PoolOptions): Pool {
  return new Pool(runtime, options);
}
