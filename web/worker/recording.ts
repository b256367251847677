// Recordings in pieces, of which no more than one is held and one is on its way.
import { BoresightError, wrong } from '../lib/runtime/errors.js';
import { isArray } from '../lib/runtime/given.js';
import type { Recording } from '../lib/types.js';

/** Bytes of a file that are read at a time. */
const PIECE_BYTES = 4 * 1024 * 1024;

export interface RecordingPiece {
  bytes: Uint8Array;
  /** Whether nobody else has the bytes. */
  own: boolean;
  /** Whether it ends a file. */
  last: boolean;
  /** Bytes so far, with these. */
  done: number;
  /** Bytes of all parts; 0 where that is not known. */
  total: number;
}

const isBlob = (part: unknown): part is Blob => part instanceof Blob;
const isIterable = (part: unknown): boolean =>
  typeof part === 'object' && part !== null && typeof Reflect.get(part, Symbol.asyncIterator) === 'function';

/** The parts of a recording, checked. */
export function partsOf(recording: Recording | readonly Recording[]): readonly Recording[] {
  const parts = isArray(recording) ? (recording as readonly Recording[]) : [recording as Recording];
  for (const part of parts) {
    if (!isBlob(part) && !isIterable(part))
      throw wrong('recording', 'a Blob, or an async iterable of Uint8Arrays', part);
  }
  return parts;
}

/** The pieces of all parts in their order. */
export async function* piecesOf(parts: readonly Recording[]): AsyncGenerator<RecordingPiece> {
  const total = parts.every(isBlob) ? parts.reduce((sum, { size }) => sum + size, 0) : 0;
  let done = 0;
  for (const part of parts) {
    const own = isBlob(part);
    // One is read while the one before is worked on.
    let before: Uint8Array | undefined;
    for await (const bytes of own ? slicesOf(part) : part) {
      if (!(bytes instanceof Uint8Array)) throw wrong('recording', 'Uint8Arrays', bytes);
      if (before) yield { bytes: before, own, last: false, done, total };
      done += bytes.byteLength;
      before = bytes;
    }
    yield { bytes: before ?? new Uint8Array(), own, last: true, done, total };
  }
}

async function* slicesOf(blob: Blob): AsyncGenerator<Uint8Array> {
  const slice = (start: number): Promise<ArrayBuffer> => {
    const bytes = blob
      .slice(start, start + PIECE_BYTES)
      .arrayBuffer()
      .catch((cause: unknown) => {
        throw unreadable(cause);
      });
    // A slice that is read ahead may fail before it is awaited, or never be awaited.
    bytes.catch(() => {});
    return bytes;
  };
  let next = slice(0);
  for (let start = 0; start < blob.size; start += PIECE_BYTES) {
    const bytes = await next;
    if (start + PIECE_BYTES < blob.size) next = slice(start + PIECE_BYTES);
    yield new Uint8Array(bytes);
  }
}

/** A file that was moved, changed or unplugged while it was read. */
function unreadable(cause: unknown): BoresightError {
  const given = cause instanceof Error ? cause.message : String(cause);
  const details = { what: 'recording', expected: 'a file that stays readable and unchanged', given };
  return new BoresightError('unreadable-file', `the recording could not be read: ${given}`, details, { cause });
}
