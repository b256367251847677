// Drives that a worker reads as their bytes come.
import { drives } from '../lib/drive/drive.js';
import { DriveStream } from '../lib/drive/stream.js';
import { failure } from '../lib/runtime/errors.js';
import type { BytesInput, Drive, ReadDriveOptions } from '../lib/types.js';

/** What the pool keeps of a drive that is read. */
export interface StreamFile {
  options: ReadDriveOptions | undefined;
}

interface Open {
  options: ReadDriveOptions | undefined;
  stream: DriveStream | undefined;
  /** Number of the instance it lives in. */
  instance: number;
  /** Pieces so far. */
  pieces: number;
}

const opened = new Map<string, Open>();

export function keepStream(id: string, { options }: StreamFile): void {
  opened.set(id, { options, stream: undefined, instance: 0, pieces: 0 });
}

export function forgetStream(id: string): void {
  // The memory of an instance that is gone went with it.
  opened.get(id)?.stream?.[Symbol.dispose]();
  opened.delete(id);
}

/** The drive, if it is the one that had all pieces before `piece`. */
function at(id: string, piece: number): { stream: DriveStream; open: Open } {
  const open = opened.get(id);
  if (open && open.pieces === 0 && piece === 0) {
    open.stream = new DriveStream(open.options);
    open.instance = drives.number;
  }
  if (!open?.stream || open.pieces !== piece || open.instance !== drives.number)
    throw failure('worker-lost', {
      what: 'worker',
      expected: 'the one that has read the recording so far',
      given: 'another one',
    });
  return { stream: open.stream, open };
}

/** Takes a piece of a recording; `last` ends its file. */
export function pushDrive(id: string, piece: number, bytes: BytesInput, last: boolean): void {
  const { stream, open } = at(id, piece);
  stream.push(bytes);
  if (last) stream.endFile();
  open.pieces += 1;
}

export function finishDrive(id: string, piece: number): Drive {
  return at(id, piece).stream.finish();
}
