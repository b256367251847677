// Entry for browsers and bundlers.
import { fetchModule } from '../lib/runtime/fetch-module.js';
import { Pool, type PoolOptions } from './api.js';
import type { Runtime } from './pool.js';
import type { Reply } from './protocol.js';

export { BoresightError } from '../lib/runtime/errors.js';
export type { PoolCapture } from './capture.js';
export type { JobOptions } from './job.js';
export { Pool, type PoolOptions };

const runtime: Runtime = {
  workers: () => Math.min(navigator.hardwareConcurrency || 2, 8),

  compile: () => fetchModule(new URL('../wasm/boresight_bg.wasm', import.meta.url)),
  compileDrives: () => fetchModule(new URL('../wasm/boresight_drives_bg.wasm', import.meta.url)),
  compileNeural: () => fetchModule(new URL('../wasm/boresight_neural_bg.wasm', import.meta.url)),

  spawn(events) {
    const worker = new Worker(new URL('./browser-worker.js', import.meta.url), { type: 'module' });
    worker.addEventListener('message', ({ data }: MessageEvent<Reply>) => events.reply(data));
    worker.addEventListener('messageerror', () => events.lost('its answer could not be read'));
    worker.addEventListener('error', (event) => events.lost(event.message || 'it could not be started'));
    return {
      post: (message, transfer) => worker.postMessage(message, transfer),
      keepAlive: () => {},
      terminate: () => worker.terminate(),
    };
  },
};

/** Makes a pool of module workers. */
export function createPool(options?: PoolOptions): Pool {
  return new Pool(runtime, options);
}
