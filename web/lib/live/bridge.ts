import { type BoresightError, failure, own } from '../runtime/errors.js';
import type { BridgeCounts, BridgeFrame, BridgeHello, BridgeOptions } from './types.js';

/** Of what `boresight bridge` sends. */
const VERSION = 1;
/** Before the samples: the frame's number. */
const HEADER_BYTES = 8;
/** Frames that wait for their reader; beyond them the oldest goes, as no socket of a page can be told to wait. */
const MOST_WAITING = 2;

const NONE: BridgeCounts = {
  packets: 0,
  bytes: 0,
  lostPackets: 0,
  lostBytes: 0,
  reordered: 0,
  duplicates: 0,
  malformed: 0,
  restarts: 0,
  frames: 0,
  damagedFrames: 0,
};

/** Raw frames of a bridge, the newest where the reader is slow. */
export class BridgeFrames implements AsyncIterable<BridgeFrame> {
  readonly #address: string;
  readonly #options: BridgeOptions;
  #hello: BridgeHello | null = null;
  #counts = NONE;
  #skipped = { bridge: 0, here: 0 };
  #waiting: BridgeFrame[] = [];
  #ended: BoresightError | 'stopped' | null = null;
  #wake: (() => void) | null = null;

  /** @internal */
  constructor(address: string, options?: BridgeOptions) {
    this.#address = address;
    this.#options = own(options, 'options') as BridgeOptions;
  }

  /** What the bridge said of itself; null until it did. */
  get hello(): BridgeHello | null {
    return this.#hello;
  }

  /** What came from the card, as the bridge last said. */
  get counts(): Readonly<BridgeCounts> {
    return this.#counts;
  }

  /** Whole frames that were passed over because they were not read in time, on the way and here. */
  get skippedFrames(): number {
    return this.#skipped.bridge + this.#skipped.here;
  }

  async *[Symbol.asyncIterator](): AsyncGenerator<BridgeFrame, void, undefined> {
    const { signal } = this.#options;
    if (signal?.aborted) return;
    const socket = this.#connect();
    const stop = (): void => this.#end('stopped');
    signal?.addEventListener('abort', stop);
    try {
      for (;;) {
        const frame = this.#waiting.shift();
        if (frame) yield frame;
        else if (this.#ended === 'stopped') return;
        else if (this.#ended) throw this.#ended;
        else
          await new Promise<void>((resolve) => {
            this.#wake = resolve;
          });
      }
    } finally {
      signal?.removeEventListener('abort', stop);
      this.#ended ??= 'stopped';
      socket.close();
    }
  }

  #connect(): WebSocket {
    let socket: WebSocket;
    try {
      socket = new WebSocket(this.#address);
    } catch (error) {
      throw this.#unreached(error instanceof Error ? error.message : String(error), error);
    }
    socket.binaryType = 'arraybuffer';
    socket.onmessage = ({ data }: MessageEvent<string | ArrayBuffer>) => {
      try {
        if (typeof data === 'string') this.#told(data);
        else this.#take(data);
      } catch (error) {
        this.#end(error as BoresightError);
        socket.close();
      }
    };
    // A close follows. A browser says no more of a failure, so that no page learns what is in a network.
    socket.onerror = () => {};
    socket.onclose = ({ reason }) =>
      this.#end(
        this.#hello ? this.#lost(reason || 'the connection ended') : this.#unreached('no answer, or a refusal'),
      );
    return socket;
  }

  #told(text: string): void {
    const message = parsed(text);
    if (message?.type === 'hello') {
      const { version } = message;
      if (version !== VERSION)
        throw failure('bridge-version', {
          what: 'the version of the bridge',
          expected: String(VERSION),
          given: String(version),
        });
      this.#hello = message as unknown as BridgeHello;
    } else if (message?.type === 'status') this.#skipped.bridge = Number(message.skippedFrames);
    this.#counts = { ...this.#counts, ...(message?.counts as BridgeCounts | undefined) };
    this.#options.onChange?.(this);
  }

  #take(data: ArrayBuffer): void {
    const expected = this.#hello?.frameBytes;
    const given = data.byteLength - HEADER_BYTES;
    if (given !== expected)
      throw failure('bridge-frame', { what: 'bytes of a frame', expected: String(expected), given: String(given) });
    const frame = {
      number: Number(new DataView(data).getBigUint64(0, true)),
      bytes: new Uint8Array(data, HEADER_BYTES),
    };
    if (this.#waiting.length >= MOST_WAITING) {
      this.#waiting.shift();
      this.#skipped.here += 1;
    }
    this.#waiting.push(frame);
    this.#wake?.();
  }

  #end(why: BoresightError | 'stopped'): void {
    this.#ended ??= why;
    this.#wake?.();
  }

  #unreached(given: string, cause?: unknown): BoresightError {
    const expected = 'a running `boresight bridge` that lets this page in (--origin)';
    return failure('bridge-not-reached', { what: `the bridge at ${this.#address}`, expected, given }, cause);
  }

  #lost(given: string): BoresightError {
    const what = `the bridge at ${this.#address}`;
    return failure('bridge-lost', { what, expected: 'a bridge that goes on', given });
  }
}

/** A message as a record, where it is one. */
function parsed(text: string): Record<string, unknown> | null {
  try {
    const message: unknown = JSON.parse(text);
    return typeof message === 'object' && message !== null ? (message as Record<string, unknown>) : null;
  } catch (cause) {
    throw failure(
      'bridge-message',
      { what: 'a message of the bridge', expected: 'JSON', given: text.slice(0, 40) },
      cause,
    );
  }
}

/**
 * Raw frames of a DCA1000 capture card as `boresight bridge` hands them on. Each is a capture of one frame for the bridge's
 * configuration (`hello.config`). Where they are not read in time whole frames are passed over, and counted.
 *
 * Throws `bridge-not-reached`, `bridge-lost`, and `bridge-version`, `bridge-frame` or `bridge-message` for another program.
 */
export function bridgeFrames(address: string, options?: BridgeOptions): BridgeFrames {
  return new BridgeFrames(address, options);
}
