// Workers of browsers, wherever their script and the modules are.
import { fetchModule } from '../lib/runtime/fetch-module.js';
import type { WorkerSource } from './options.js';
import type { Runtime } from './pool.js';
import type { Reply, WorkerEvents, WorkerLike } from './protocol.js';

/** What entries of browsers differ in. */
export interface Packaged extends Pick<Runtime, 'packaged' | 'prepare'> {
  /** Starts a worker of the package's own script. */
  start(): Worker;
}

export const browserRuntime = ({ start, ...packaged }: Packaged): Runtime => ({
  ...packaged,
  workers: () => Math.min(globalThis.navigator?.hardwareConcurrency || 2, 8),
  fetched: fetchModule,
  spawn: (events, source) => attached(source === undefined ? start() : from(source), events),
});

function from(source: WorkerSource): Worker {
  if (typeof source === 'function') return source() as Worker;
  return new Worker(source, { type: 'module' });
}

function attached(worker: Worker, events: WorkerEvents): WorkerLike {
  let answered = false;
  worker.addEventListener('message', ({ data }: MessageEvent<Reply>) => {
    answered = true;
    events.reply(data);
  });
  worker.addEventListener('messageerror', () => events.lost('its answer could not be read'));
  worker.addEventListener('error', ({ message }) => {
    // A script that is refused or not found has no message, what a script throws has.
    if (answered || message) events.lost(message || 'it ended');
    else events.refused('its script was refused or not found');
  });
  return {
    post: (message, transfer) => worker.postMessage(message, transfer),
    keepAlive: () => {},
    terminate: () => worker.terminate(),
  };
}
