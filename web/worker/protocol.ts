// What travels between the pool and a worker.
import type { PlainError } from '../lib/runtime/errors.js';
import type { CaptureFile, Limits, NetworkFile } from '../lib/types.js';
import type { operations } from './operations.js';
import type { StreamFile } from './streams.js';

export type Operations = typeof operations;
export type OperationName = keyof Operations;

/** Files that a worker keeps for the jobs that name them. */
export interface Files {
  network: NetworkFile;
  capture: CaptureFile;
  stream: StreamFile;
}

/** What a worker is given before it needs it: compiled modules, the core's first, and files to keep or to forget. */
export type Setup =
  | { module: WebAssembly.Module }
  | { limits: Limits }
  | { drives: WebAssembly.Module }
  | { neural: WebAssembly.Module }
  | { [K in keyof Files]: { keep: K; of: string; file: Files[K] } }[keyof Files]
  | { forget: keyof Files; of: string };

/** One piece of work. */
export interface Request {
  id: number;
  name: OperationName;
  args: readonly unknown[];
}

/** Its outcome and the memory that the worker holds, or how far it is. */
export type Reply =
  | { id: number; result: unknown; memoryBytes: number }
  | { id: number; error: PlainError; memoryBytes: number }
  | { id: number; done: number; total: number };

/** What the pool needs of a worker, whichever runtime it lives in. */
export interface WorkerLike {
  post(message: Setup | Request, transfer: Transferable[]): void;
  /** Whether the process stays alive for its sake; nothing in browsers. */
  keepAlive(busy: boolean): void;
  /** Ends what it does at its next report; without this, only ending the worker does. */
  stop?(): void;
  terminate(): void;
}

/** What a worker tells the pool. */
export interface WorkerEvents {
  reply(reply: Reply): void;
  /** The worker is gone and will say nothing more. */
  lost(reason: string): void;
  /** The host did not let it start. */
  refused(reason: string): void;
}
