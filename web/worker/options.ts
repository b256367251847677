// Options of a pool.
import { own, reading, wrong } from '../lib/runtime/errors.js';
import type { Limits } from '../lib/types.js';
import type { PoolModules } from './modules.js';

/** What a pool needs of a worker of its runtime. */
export interface WorkerObject {
  // biome-ignore lint/suspicious/noExplicitAny: browsers and Node differ in what they take
  postMessage(message: any, transfer?: any): void;
  terminate(): unknown;
}

/** The script of a worker, or what starts one: a `Worker` of browsers, or of Node's `worker_threads`. */
export type WorkerSource = URL | string | (() => WorkerObject);

/** Options of {@link createPool}. */
export interface PoolOptions {
  /**
   * Number of workers; by default one a processor core, at most 8. With 0 the work is done on the calling thread, for
   * hosts that allow no workers: jobs take turns with what else the thread has to do, and what runs stops only where it
   * reports progress.
   */
  workers?: number;
  /**
   * Where workers come from: the address of the package's `boresight.worker.js` (or of what a bundler makes of it), or a
   * function that starts one from it. By default the script beside the package's own.
   */
  worker?: WorkerSource;
  /** Where modules come from; by default files beside the package's own. */
  modules?: PoolModules;
  /** What one call of a worker may take; by default any number of operations, and the default of bytes. */
  limits?: Limits;
}

/** A copy of options, checked as far as they are read before a job. */
export function checkedOptions(options: PoolOptions | undefined): PoolOptions {
  const { workers, worker, modules, limits } = own(options, 'options', [
    'workers',
    'worker',
    'modules',
    'limits',
  ]) as PoolOptions;
  const isSource = typeof worker === 'string' || typeof worker === 'function' || worker instanceof URL;
  if (worker != null && !isSource) throw wrong('worker', 'an address, or a function that starts a worker', worker);
  return reading('options', () => ({
    ...(workers !== undefined && { workers }),
    ...(worker != null && { worker }),
    ...(modules != null && { modules }),
    ...(limits != null && { limits: own(limits, 'limits', ['operations', 'bytes']) as Limits }),
  }));
}
