import { failure } from './errors.js';
import type { Instance } from './module.js';

const dispose: typeof Symbol.dispose = Symbol.dispose ?? Symbol.for('Symbol.dispose');

/** Something that lives in wasm memory until `free()`, or until it is garbage collected. */
export class Handle<Raw extends { free(): void }> {
  readonly #instance: Instance;
  readonly #number: number;
  #raw: Raw | undefined;
  #busy = false;

  protected constructor(instance: Instance, make: () => Raw) {
    this.#instance = instance;
    this.#number = instance.number;
    this.#raw = instance.call(make);
  }

  /** Runs a method of the raw handle. */
  protected use<T>(work: (raw: Raw) => T): T {
    const raw = this.#idle();
    this.#busy = true;
    try {
      return this.#instance.call(() => work(raw));
    } finally {
      this.#busy = false;
    }
  }

  /** Gives the memory back. The handle cannot be used any more, nor freed again. */
  free(): void {
    const raw = this.#raw;
    if (raw === undefined) throw this.#misuse('freed');
    if (this.#busy) throw this.#misuse('busy');
    this.#raw = undefined;
    // The memory of a dead instance went with it.
    if (this.#instance.isAlive(this.#number)) this.#instance.call(() => raw.free());
  }

  /** For `using`: frees the handle unless that was done already. */
  [dispose](): void {
    if (this.#raw !== undefined) this.free();
  }

  #idle(): Raw {
    if (this.#raw === undefined) throw this.#misuse('freed');
    if (this.#number !== this.#instance.number) throw this.#misuse('stale');
    // A callback of a running method called another one.
    if (this.#busy) throw this.#misuse('busy');
    return this.#raw;
  }

  #misuse(state: keyof typeof misuses): Error {
    const given = misuses[state];
    return failure(`handle-${state}`, { what: this.constructor.name, expected: 'a live, idle handle', given });
  }
}

const misuses = { freed: 'freed', stale: 'of an instance that stopped', busy: 'busy with another call' };
