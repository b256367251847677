/** The package, as the pages use it: one place that loads it, and one pool of workers. */
import * as boresight from 'boresight';
import { createPool, type Pool } from 'boresight/worker';
import { networksModule } from './networks/address.ts';

export const api = boresight;

/** An error as the pages show it. */
export interface Problem {
  code: string;
  message: string;
}

/** What is wrong with a file, before the package has seen it. */
export class FileProblem extends Error {
  readonly code: string;
  readonly file: string;

  constructor(code: string, file: string, message: string, options?: ErrorOptions) {
    super(message, options);
    this.code = code;
    this.file = file;
  }
}

export function describeError(error: unknown): Problem {
  if (aborted(error)) return { code: 'cancelled', message: 'It was cancelled.' };
  if (error instanceof FileProblem) return { code: error.code, message: `${error.file}: ${error.message}` };
  if (error instanceof boresight.BoresightError) return { code: error.code, message: error.message };
  return { code: 'unexpected', message: error instanceof Error ? error.message : String(error) };
}

export function aborted(error: unknown): boolean {
  return error instanceof Error && error.name === 'AbortError';
}

/** What runs at the same time. */
export const WORKERS = Math.min(Math.max((navigator.hardwareConcurrency || 2) - 1, 1), 4);

let workers: Pool | undefined;

/** Workers start with the first call that needs them. */
export function pool(): Pool {
  workers ??= createPool({ workers: WORKERS, modules: { networks: networksModule } });
  return workers;
}

export function load(): Promise<void> {
  return boresight.init();
}
