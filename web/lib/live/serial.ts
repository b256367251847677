import { failure, own } from '../runtime/errors.js';
import type { BoardPort, SerialCounts, SerialOptions, SerialState } from './types.js';

export const DATA_BAUD = 921_600;
const LEAST_BUFFER = 65_536;
/** Errors in a row without a byte between them, after which a port is not asked again. */
const MOST_ERRORS = 1000;
/** How long until a lost port is tried again where nothing tells that it is back, ms. */
const RETRY_MS = 1000;

/** Counts by the names of the errors after which a port goes on with another stream. */
const COUNTED: Readonly<Record<string, keyof SerialCounts>> = {
  FramingError: 'framingErrors',
  ParityError: 'parityErrors',
  BreakError: 'breaks',
  BufferOverrunError: 'overruns',
};

/**
 * Bytes of a serial port as they come. After an error of the line the port has another stream, which is read on; an
 * unplugged port is waited for. What it opened it closes in the end.
 */
export class SerialBytes implements AsyncIterable<Uint8Array> {
  readonly #counts: SerialCounts = {
    bytes: 0,
    framingErrors: 0,
    parityErrors: 0,
    breaks: 0,
    overruns: 0,
    otherErrors: 0,
    losses: 0,
  };
  readonly #options: SerialOptions & { baudRate: number; bufferSize: number };
  #port: BoardPort;
  #state: SerialState = 'opening';
  #begun = false;
  #errorsInRow = 0;
  #reader: ReadableStreamDefaultReader<Uint8Array> | null = null;
  /** Ends a wait. */
  #wake: (() => void) | null = null;

  /** @internal */
  constructor(port: BoardPort, given?: SerialOptions) {
    const options = own(given, 'options') as SerialOptions;
    const { baudRate = DATA_BAUD, bufferSize = 4 * LEAST_BUFFER } = options;
    for (const [what, least, given] of [
      ['baudRate', 1, baudRate],
      ['bufferSize', LEAST_BUFFER, bufferSize],
    ] as const) {
      if (!(Number.isInteger(given) && given >= least))
        throw failure('out-of-range', { what, expected: `an integer of at least ${least}`, given: String(given) });
    }
    this.#port = port;
    this.#options = { ...options, baudRate, bufferSize };
  }

  get state(): SerialState {
    return this.#state;
  }

  get counts(): Readonly<SerialCounts> {
    return this.#counts;
  }

  /** Goes on with another port, such as that of a board that was plugged in elsewhere. */
  usePort(port: BoardPort): void {
    if (port === this.#port) return;
    this.#port = port;
    this.#interrupt();
  }

  async *[Symbol.asyncIterator](): AsyncGenerator<Uint8Array, void, undefined> {
    if (this.#begun)
      throw failure('port-in-use', { what: 'the bytes of a port', expected: 'one reader', given: 'two' });
    this.#begun = true;
    const { signal } = this.#options;
    signal?.addEventListener('abort', this.#interrupt);
    try {
      while (!signal?.aborted) {
        const port = this.#port;
        const mine = await this.#open(port);
        if (mine === null) {
          await this.#wait(port);
          continue;
        }
        try {
          yield* this.#readAll(port);
        } finally {
          if (mine) await port.close().catch(() => {});
        }
        if (this.#port !== port || signal?.aborted) continue;
        if (this.#state !== 'lost') return;
        await this.#wait(port);
      }
    } finally {
      signal?.removeEventListener('abort', this.#interrupt);
      this.#say('ended');
    }
  }

  /** Whether it was opened here; null for a port that is not back yet. */
  async #open(port: BoardPort): Promise<boolean | null> {
    const again = this.#state === 'lost';
    try {
      const mine = await openPort(port, this.#options);
      this.#say('open');
      return mine;
    } catch (error) {
      if (again) return null;
      throw error;
    }
  }

  async *#readAll(port: BoardPort): AsyncGenerator<Uint8Array, void, undefined> {
    const { signal } = this.#options;
    while (port.readable && this.#port === port && !signal?.aborted) {
      const reader = port.readable.getReader();
      this.#reader = reader;
      try {
        for (;;) {
          const read = await reader.read().catch((error: unknown) => {
            this.#count(error);
            return null;
          });
          if (read === null) break;
          // Closed by whoever holds the port, or interrupted here.
          if (read.done) return;
          this.#errorsInRow = 0;
          this.#counts.bytes += read.value.length;
          if (read.value.length) yield read.value;
        }
      } finally {
        this.#reader = null;
        reader.releaseLock();
      }
    }
    if (port.readable || this.#port !== port || signal?.aborted) return;
    this.#counts.losses += 1;
    this.#say('lost');
    if (this.#options.reconnect === false)
      throw failure('port-lost', { what: 'the serial port', expected: 'a board that stays plugged in', given: 'gone' });
  }

  #count(error: unknown): void {
    const name = error instanceof Error || error instanceof DOMException ? error.name : '';
    // A port that is gone is counted as such.
    if (name === 'NetworkError') return;
    this.#counts[COUNTED[name] ?? 'otherErrors'] += 1;
    this.#errorsInRow += 1;
    if (this.#errorsInRow > MOST_ERRORS)
      throw failure(
        'port-failing',
        { what: 'the serial port', expected: 'bytes between errors', given: `${this.#errorsInRow} errors, ${name}` },
        error,
      );
    this.#options.onChange?.(this);
  }

  /** Until a port may be back, another one is given, or reading ends. */
  #wait(port: BoardPort): Promise<void> {
    if (this.#options.signal?.aborted || this.#port !== port) return Promise.resolve();
    return new Promise((resolve) => {
      const done = (): void => {
        clearTimeout(timer);
        port.removeEventListener('connect', done);
        this.#wake = null;
        resolve();
      };
      const timer = setTimeout(done, RETRY_MS);
      port.addEventListener('connect', done);
      this.#wake = done;
    });
  }

  #interrupt = (): void => {
    this.#wake?.();
    this.#reader?.cancel().catch(() => {});
  };

  #say(state: SerialState): void {
    if (this.#state === state) return;
    this.#state = state;
    this.#options.onChange?.(this);
  }
}

/** Opens a port that is not open; whether it had to. */
export async function openPort(
  port: BoardPort,
  { baudRate, bufferSize }: { baudRate: number; bufferSize: number },
): Promise<boolean> {
  if (port.readable) return false;
  try {
    await port.open({ baudRate, bufferSize });
  } catch (error) {
    const given = error instanceof Error ? error.message : String(error);
    const expected = 'one that no other program or page has open';
    throw failure('port-not-opened', { what: 'the serial port', expected, given }, error);
  }
  return true;
}

/**
 * Bytes of a serial port (Web Serial) as they come, as an async iterable with counts of what went wrong. After framing
 * errors, breaks and overruns the port's new stream is read on; an unplugged port is waited for.
 *
 * Throws `port-not-opened` where the port cannot be opened at first, `port-failing` where it gives errors alone, and with
 * `reconnect: false` `port-lost`.
 */
export function serialBytes(port: BoardPort, options?: SerialOptions): SerialBytes {
  return new SerialBytes(port, options);
}
