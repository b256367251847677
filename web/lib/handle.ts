import { failure } from './errors.js';
import { call, instanceNumber, isAlive } from './instance.js';

const dispose: typeof Symbol.dispose = Symbol.dispose ?? Symbol.for('Symbol.dispose');

/** Something that lives in wasm memory until `free()`, or until it is garbage collected. */
export class Handle<Raw extends { free(): void }> {
  readonly #instance = instanceNumber();
  #raw: Raw | undefined;

  protected constructor(make: () => Raw) {
    this.#raw = call(make);
  }

  /** Runs a method of the raw handle. */
  protected use<T>(work: (raw: Raw) => T): T {
    return call(() => work(this.#live()));
  }

  /** Gives the memory back. The handle cannot be used any more, nor freed again. */
  free(): void {
    const raw = this.#raw;
    if (raw === undefined) throw this.#misuse('freed');
    this.#raw = undefined;
    // The memory of a dead instance went with it.
    if (isAlive(this.#instance)) call(() => raw.free());
  }

  /** For `using`: frees the handle unless that was done already. */
  [dispose](): void {
    if (this.#raw !== undefined) this.free();
  }

  #live(): Raw {
    if (this.#raw === undefined) throw this.#misuse('freed');
    if (this.#instance !== instanceNumber()) throw this.#misuse('of an instance that stopped');
    return this.#raw;
  }

  #misuse(given: string): Error {
    const code = given === 'freed' ? 'freed' : 'stale-handle';
    return failure(code, { what: this.constructor.name, expected: 'a live handle', given });
  }
}
