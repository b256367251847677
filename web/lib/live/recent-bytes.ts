import { failure, own } from '../runtime/errors.js';
import type { RecentCounts, RecentOptions } from './types.js';

interface Piece {
  timeMs: number;
  bytes: Uint8Array;
}

/** The last bytes of a stream, by age and by amount; what it forgets it counts. */
export class RecentBytes {
  readonly #most: { ms: number; bytes: number };
  #pieces: Piece[] = [];
  #first = 0;
  #bytes = 0;
  #forgotten = 0;

  constructor(options?: RecentOptions) {
    const { seconds = 60, bytes = 64 * 2 ** 20 } = own(options, 'options') as RecentOptions;
    for (const [what, given] of Object.entries({ seconds, bytes })) {
      if (!(given > 0)) throw failure('out-of-range', { what, expected: 'a number above 0', given: String(given) });
    }
    this.#most = { ms: 1000 * seconds, bytes };
  }

  /** Keeps a copy of the next bytes, which came at `timeMs` of any clock that does not run backwards. */
  push(bytes: Uint8Array, timeMs: number = performance.now()): void {
    const over = Math.max(bytes.length - this.#most.bytes, 0);
    this.#forgotten += over;
    this.#pieces.push({ timeMs, bytes: bytes.slice(over) });
    this.#bytes += bytes.length - over;
    for (;;) {
      const oldest = this.#pieces[this.#first];
      if (!oldest || (this.#bytes <= this.#most.bytes && timeMs - oldest.timeMs <= this.#most.ms)) break;
      this.#first += 1;
      this.#bytes -= oldest.bytes.length;
      this.#forgotten += oldest.bytes.length;
    }
    if (2 * this.#first > this.#pieces.length) {
      this.#pieces = this.#pieces.slice(this.#first);
      this.#first = 0;
    }
  }

  /** A source that hands bytes on and keeps the last of them. */
  async *of(source: AsyncIterable<Uint8Array>): AsyncGenerator<Uint8Array, void, undefined> {
    for await (const bytes of source) {
      this.push(bytes);
      yield bytes;
    }
  }

  get counts(): RecentCounts {
    const [oldest, newest] = [this.#pieces[this.#first], this.#pieces.at(-1)];
    const seconds = oldest && newest ? (newest.timeMs - oldest.timeMs) / 1000 : 0;
    return { bytes: this.#bytes, seconds, forgottenBytes: this.#forgotten };
  }

  /** What is kept, as a file has it. */
  bytes(): Uint8Array<ArrayBuffer> {
    const whole = new Uint8Array(this.#bytes);
    let at = 0;
    for (const { bytes } of this.#pieces.slice(this.#first)) {
      whole.set(bytes, at);
      at += bytes.length;
    }
    return whole;
  }
}
