// The one wasm instance: made by init(), replaced by the next init() after a trap.
import instantiate, * as glue from '../wasm/boresight.js';
import { BoresightError, failure, isPlainError } from './errors.js';

/** Where the wasm comes from: an address, a response, bytes or a compiled module. */
export type WasmSource = URL | string | Request | Response | BufferSource | WebAssembly.Module;

let state: 'none' | 'ready' | 'dead' = 'none';
let pending: Promise<void> | undefined;
let generation = 0;
let lastWords = '';

/**
 * Makes the instance ready. Calls at a time share one attempt, later ones return at once, and after
 * a failure the next call tries again. After a trap a fresh instance is made from the same module.
 */
export async function start(source: () => WasmSource | Promise<WasmSource>): Promise<void> {
  if (state !== 'none') {
    revive();
    return;
  }
  pending ??= (async () => {
    try {
      await instantiate({ module_or_path: await source() });
      if (state === 'none') state = 'ready';
    } catch (cause) {
      throw notLoaded(cause);
    } finally {
      pending = undefined;
    }
  })();
  return pending;
}

/** Makes the instance ready from a compiled module or its bytes, without waiting. */
export function initSync(module: WebAssembly.Module | BufferSource): void {
  if (state !== 'none') {
    revive();
    return;
  }
  try {
    glue.initSync({ module });
    state = 'ready';
  } catch (cause) {
    throw notLoaded(cause);
  }
}

function revive(): void {
  if (state !== 'dead') return;
  glue.__wbg_reset_state();
  generation += 1;
  state = 'ready';
}

function notLoaded(cause: unknown): BoresightError {
  const given = cause instanceof Error ? cause.message : String(cause);
  const message = `the WebAssembly module could not be loaded: ${given}`;
  const details = { what: 'WebAssembly module', expected: 'the boresight_bg.wasm of this package', given };
  return new BoresightError('not-loaded', message, details, { cause });
}

/** Whether memory of the instance with this number is still there. */
export function isAlive(instance: number): boolean {
  return state === 'ready' && generation === instance;
}

/** Number of the instance, which changes after a trap. */
export function instanceNumber(): number {
  return generation;
}

/** Runs a function of the bindings and turns what it throws into a {@link BoresightError}. */
export function call<T>(work: () => T): T {
  if (state === 'none') {
    throw failure('not-initialised', { what: 'Boresight', expected: 'await init() first', given: 'not initialised' });
  }
  if (state === 'dead') throw dead();
  try {
    return work();
  } catch (thrown) {
    if (isPlainError(thrown)) throw BoresightError.fromPlain(thrown);
    if (thrown instanceof BoresightError) throw thrown;
    // Anything else left wasm without unwinding it, so its memory cannot be trusted.
    state = 'dead';
    lastWords = panicMessage() || (thrown instanceof Error ? thrown.message : String(thrown));
    throw dead(thrown);
  }
}

function panicMessage(): string {
  try {
    return glue.lastPanic();
  } catch {
    return '';
  }
}

function dead(cause?: unknown): BoresightError {
  const details = { what: 'WebAssembly instance', expected: 'init() again for a fresh one', given: lastWords };
  const message = `Boresight stopped unexpectedly (${lastWords}); call init() for a fresh instance`;
  return new BoresightError('trap', message, details, cause === undefined ? undefined : { cause });
}
