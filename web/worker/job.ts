// What callers say of one job, and what becomes of what their arguments throw.
import { BoresightError, failure, own, wrong } from '../lib/runtime/errors.js';

/** Options of one job. */
export interface JobOptions {
  /** Cancels the job, which then rejects with the signal's reason, an `AbortError` by default. */
  signal?: AbortSignal;
  /** Called as pieces of the job are done, in the job's own units (inputs, frames, scenes). */
  onProgress?: (done: number, total: number) => void;
  /** Gives the typed arrays among the arguments away instead of copying them. */
  transfer?: boolean;
}

/** A copy of a job's options, checked; none of them where there are no options. */
export function checkedJob(job: unknown): JobOptions {
  const { signal, onProgress, transfer } = own<JobOptions>(job ?? undefined, 'job', [
    'signal',
    'onProgress',
    'transfer',
  ]);
  if (signal != null && !(signal instanceof AbortSignal)) throw wrong('job.signal', 'an AbortSignal', signal);
  if (onProgress != null && typeof onProgress !== 'function') throw wrong('job.onProgress', 'a function', onProgress);
  if (transfer != null && typeof transfer !== 'boolean') throw wrong('job.transfer', 'true or false', transfer);
  return {
    ...(signal != null && { signal }),
    ...(onProgress != null && { onProgress: onProgress as NonNullable<JobOptions['onProgress']> }),
    ...(transfer != null && { transfer }),
  };
}

/** What callbacks of jobs threw. */
const thrownByCallbacks = new WeakSet<object>();

/** What a callback of a job threw, with which the job rejects as it is. */
export function passedOn(thrown: unknown): unknown {
  if (typeof thrown === 'object' && thrown !== null) thrownByCallbacks.add(thrown);
  return thrown;
}

/**
 * Has the methods of a class that give promises reject with errors of the package, or with what a job was cancelled with
 * or its callback threw, whatever errors come of reading their arguments.
 */
export function rejectTyped(prototype: object, names: readonly string[]): void {
  for (const name of names) {
    const method = Reflect.get(prototype, name) as (...args: unknown[]) => Promise<unknown>;
    const value = async function (this: object, ...args: unknown[]): Promise<unknown> {
      try {
        return await method.apply(this, args);
      } catch (cause) {
        const own = !(cause instanceof Error) || cause instanceof BoresightError || thrownByCallbacks.has(cause);
        if (own || isReason(cause, args)) throw cause;
        const details = { what: 'arguments', expected: 'objects that can be read', given: cause.message };
        throw failure('wrong-type', details, cause);
      }
    };
    Object.defineProperty(prototype, name, { value, configurable: true, writable: true });
  }
}

/** Whether this is what a job among the arguments was cancelled with. */
function isReason(cause: unknown, args: unknown[]): boolean {
  try {
    return args.some((job) => (job as JobOptions | null | undefined)?.signal?.reason === cause);
  } catch {
    return false;
  }
}
