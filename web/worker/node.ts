// Entry for Node.
import { availableParallelism } from 'node:os';
import { type TransferListItem, Worker } from 'node:worker_threads';
import { readModule } from '../lib/runtime/read-module.js';
import { Pool, type PoolOptions } from './api.js';
import type { Runtime } from './pool.js';
import type { Reply } from './protocol.js';

export { BoresightError } from '../lib/runtime/errors.js';
export type { PoolCapture } from './capture.js';
export type { JobOptions } from './job.js';
export { Pool, type PoolOptions };

const runtime: Runtime = {
  workers: () => Math.min(availableParallelism(), 8),

  compile: () => readModule(new URL('../wasm/boresight_bg.wasm', import.meta.url)),
  compileDrives: () => readModule(new URL('../wasm/boresight_drives_bg.wasm', import.meta.url)),
  compileNeural: () => readModule(new URL('../wasm/boresight_neural_bg.wasm', import.meta.url)),

  spawn(events) {
    const worker = new Worker(new URL('./node-worker.js', import.meta.url));
    worker.unref();
    worker.on('message', (reply: Reply) => events.reply(reply));
    worker.on('messageerror', (error) => events.lost(error.message));
    worker.on('error', (error) => events.lost(error.message));
    worker.on('exit', (code) => events.lost(`it ended with code ${code}`));
    return {
      post: (message, transfer) => worker.postMessage(message, transfer as TransferListItem[]),
      keepAlive: (busy) => (busy ? worker.ref() : worker.unref()),
      terminate: () => void worker.terminate(),
    };
  },
};

/** Makes a pool of worker threads. Idle workers do not keep the process alive. */
export function createPool(options?: PoolOptions): Pool {
  return new Pool(runtime, options);
}
