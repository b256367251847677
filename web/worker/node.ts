// Entry for Node.
import { availableParallelism } from 'node:os';
import { type TransferListItem, Worker } from 'node:worker_threads';
import { fetchModule } from '../lib/runtime/fetch-module.js';
import { readModule } from '../lib/runtime/read-module.js';
import { Pool } from './api.js';
import type { PoolOptions } from './options.js';
import type { Runtime } from './pool.js';
import type { Reply } from './protocol.js';

export * from './exports.js';

const runtime: Runtime = {
  workers: () => Math.min(availableParallelism(), 8),
  packaged: () => ({
    core: new URL('../wasm/boresight_bg.wasm', import.meta.url),
    drives: new URL('../wasm/boresight_drives_bg.wasm', import.meta.url),
  }),
  fetched: (address) => (address.protocol === 'file:' ? readModule(address) : fetchModule(address)),

  spawn(events, source = new URL('./node-worker.js', import.meta.url)) {
    const worker = typeof source === 'function' ? (source() as Worker) : new Worker(source);
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
