// Instances of wasm modules: made by init(), replaced by the next init() after a trap.
import type { Limits } from '../generated/options.js';
import { BoresightError, failure, isPlainError } from './errors.js';

/** Where the wasm comes from: an address, a response, bytes or a compiled module. */
export type WasmSource = URL | string | Request | Response | BufferSource | WebAssembly.Module;

interface Exports {
  memory: WebAssembly.Memory;
}

/** What is used of the bindings of a module. */
interface Glue {
  initSync(options: { module: WebAssembly.Module | BufferSource }): Exports;
  __wbg_reset_state(): void;
  lastPanic(): string;
  setLimits(limits: Limits | undefined): void;
}

/** One module and its instance. */
export class Instance {
  static readonly #all = new Set<Instance>();
  static #limits: Limits | undefined;
  readonly #glue: Glue;
  readonly #instantiate: (options: { module_or_path: WasmSource }) => Promise<Exports>;
  readonly #file: string;
  readonly #init: string;
  #state: 'none' | 'ready' | 'dead' = 'none';
  #pending: Promise<void> | undefined;
  #generation = 0;
  #lastWords = '';
  #memory: WebAssembly.Memory | undefined;

  /** `file` and `init` name the module and what loads it in errors. */
  constructor(
    glue: Glue,
    instantiate: (options: { module_or_path: WasmSource }) => Promise<Exports>,
    names: { file: string; init: string },
  ) {
    this.#glue = glue;
    this.#instantiate = instantiate;
    this.#file = names.file;
    this.#init = names.init;
    Instance.#all.add(this);
  }

  /** Sets what one call may take, of the modules that are loaded and of those that will be. */
  static setLimits(limits: Limits | undefined): void {
    const loaded = [...Instance.#all].filter((instance) => instance.#state === 'ready');
    // The first that refuses them does so before any has them.
    for (const instance of loaded) instance.call(() => instance.#glue.setLimits(limits));
    Instance.#limits = limits && { ...limits };
  }

  /** Runs work with other limits than those of this thread. */
  static withLimits<T>(limits: Limits, work: () => T): T {
    const before = Instance.#limits;
    Instance.setLimits(limits);
    try {
      return work();
    } finally {
      Instance.setLimits(before);
    }
  }

  #ready(): void {
    this.#state = 'ready';
    const limits = Instance.#limits;
    if (limits !== undefined) this.call(() => this.#glue.setLimits(limits));
  }

  /**
   * Makes the instance ready. Calls at a time share one attempt, later ones return at once, and after
   * a failure the next call tries again. After a trap a fresh instance is made from the same module.
   */
  async start(source: () => WasmSource | Promise<WasmSource>): Promise<void> {
    if (this.#state !== 'none') {
      this.#revive();
      return;
    }
    this.#pending ??= (async () => {
      try {
        this.#memory = (await this.#instantiate({ module_or_path: await source() })).memory;
        if (this.#state === 'none') this.#ready();
      } catch (cause) {
        throw this.#notLoaded(cause);
      } finally {
        this.#pending = undefined;
      }
    })();
    return this.#pending;
  }

  /** Makes the instance ready from a compiled module or its bytes, without waiting. */
  startSync(module: WebAssembly.Module | BufferSource): void {
    if (this.#state !== 'none') {
      this.#revive();
      return;
    }
    try {
      this.#memory = this.#glue.initSync({ module }).memory;
      this.#ready();
    } catch (cause) {
      throw this.#notLoaded(cause);
    }
  }

  #revive(): void {
    if (this.#state !== 'dead') return;
    this.#glue.__wbg_reset_state();
    this.#generation += 1;
    this.#ready();
  }

  #notLoaded(cause: unknown): BoresightError {
    const given = cause instanceof Error ? cause.message : String(cause);
    const message = `the WebAssembly module could not be loaded: ${given}`;
    const details = { what: 'WebAssembly module', expected: `the ${this.#file} of this package`, given };
    return new BoresightError('not-loaded', message, details, { cause });
  }

  /** Whether memory of the instance with this number is still there. */
  isAlive(number: number): boolean {
    return this.#state === 'ready' && this.#generation === number;
  }

  /** Number of the instance, which changes after a trap. */
  get number(): number {
    return this.#generation;
  }

  /** Memory of the instance, which grows and never shrinks, bytes. */
  get memoryBytes(): number {
    return this.#memory?.buffer.byteLength ?? 0;
  }

  /** Runs a function of the bindings and turns what it throws into a {@link BoresightError}. */
  call<T>(work: () => T): T {
    if (this.#state === 'none') {
      const details = { what: 'Boresight', expected: `await ${this.#init} first`, given: 'not initialised' };
      throw failure('not-initialised', details);
    }
    if (this.#state === 'dead') throw this.#dead();
    try {
      return work();
    } catch (thrown) {
      if (isPlainError(thrown)) throw BoresightError.fromPlain(thrown);
      if (thrown instanceof BoresightError) throw thrown;
      // Anything else left wasm without unwinding it, so its memory cannot be trusted.
      this.#state = 'dead';
      this.#lastWords = this.#panicMessage() || (thrown instanceof Error ? thrown.message : String(thrown));
      throw this.#dead(thrown);
    }
  }

  #panicMessage(): string {
    try {
      return this.#glue.lastPanic();
    } catch {
      return '';
    }
  }

  #dead(cause?: unknown): BoresightError {
    const details = {
      what: 'WebAssembly instance',
      expected: `${this.#init} again for a fresh one`,
      given: this.#lastWords,
    };
    const message = `Boresight stopped unexpectedly (${this.#lastWords}); call ${this.#init} for a fresh instance`;
    return new BoresightError('trap', message, details, cause === undefined ? undefined : { cause });
  }
}
