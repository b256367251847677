// What every runtime's entry of the pool offers beside its own createPool().

export { BoresightError } from '../lib/runtime/errors.js';
export { Pool } from './api.js';
export type { PoolCapture } from './capture.js';
export type { JobOptions } from './job.js';
export type { ModuleSource, PoolModules } from './modules.js';
export type { PoolOptions, WorkerObject, WorkerSource } from './options.js';
