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

/** Makes a pool of module workers. */
export function createPool(options?: PoolOptions): Pool {
  return new Pool(runtime, options);
}
