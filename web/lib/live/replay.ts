import { failure, own, wrong } from '../runtime/errors.js';
import type { BytesInput } from '../types.js';
import { DATA_BAUD } from './serial.js';
import type { ReplayOptions } from './types.js';

/** A start bit, eight of data, a stop bit. */
const BITS_A_BYTE = 10;
/** Between two pieces at a pace, ms. */
const TICK_MS = 20;
/** Without a rest, ms. */
const BUSY_MS = 10;
const PIECE = 4096;

/**
 * Bytes of a file as they would come over a port: at its speed, faster, or as fast as they are taken. Ends early, without
 * an error, when the signal says so.
 */
export function replayBytes(data: BytesInput | Blob, options?: ReplayOptions): AsyncIterable<Uint8Array> {
  const {
    rate = 1,
    bytesPerSecond = DATA_BAUD / BITS_A_BYTE,
    pieceBytes = PIECE,
    signal,
  } = own(options, 'options') as ReplayOptions;
  for (const [what, given, most] of [
    ['rate', rate, Number.POSITIVE_INFINITY],
    ['bytesPerSecond', bytesPerSecond, Number.MAX_VALUE],
    ['pieceBytes', pieceBytes, Number.MAX_SAFE_INTEGER],
  ] as const) {
    if (!(given > 0 && given <= most))
      throw failure('out-of-range', { what, expected: 'a number above 0', given: String(given) });
  }
  const read = reader(data);
  const perMs = (rate * bytesPerSecond) / 1000;
  const most = Math.max(Math.floor(pieceBytes), 1);
  return {
    async *[Symbol.asyncIterator]() {
      const begun = performance.now();
      let rested = begun;
      for (let at = 0; at < read.length && !signal?.aborted; ) {
        const now = performance.now();
        const due = Number.isFinite(perMs) ? Math.min(Math.floor((now - begun) * perMs), read.length) : read.length;
        // Promises alone would not let a page draw.
        if (due <= at || now - rested > BUSY_MS) {
          await pause(due <= at ? TICK_MS : 0, signal);
          rested = performance.now();
          continue;
        }
        const piece = await read.piece(at, Math.min(at + most, due));
        at += piece.length;
        yield piece;
      }
    },
  };
}

interface Pieces {
  length: number;
  piece(from: number, to: number): Promise<Uint8Array> | Uint8Array;
}

function reader(data: BytesInput | Blob): Pieces {
  if (data instanceof Blob)
    return {
      length: data.size,
      piece: async (from, to) => new Uint8Array(await data.slice(from, to).arrayBuffer()),
    };
  if (!(data instanceof Uint8Array || data instanceof ArrayBuffer))
    throw wrong('recording', 'a Uint8Array, an ArrayBuffer or a Blob', data);
  const bytes = data instanceof Uint8Array ? data : new Uint8Array(data);
  return { length: bytes.length, piece: (from, to) => bytes.slice(from, to) };
}

function pause(ms: number, signal: AbortSignal | undefined): Promise<void> {
  return new Promise((resolve) => {
    const done = (): void => {
      clearTimeout(timer);
      signal?.removeEventListener('abort', done);
      resolve();
    };
    const timer = setTimeout(done, ms);
    signal?.addEventListener('abort', done);
    if (signal?.aborted) done();
  });
}
