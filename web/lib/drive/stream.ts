import * as glue from '../../wasm/boresight_drives.js';
import { Handle } from '../runtime/handle.js';
import type { BytesInput, Drive, ReadDriveOptions } from '../types.js';
import { drives } from './drive.js';

/**
 * Reads a drive from the bytes of an MCAP file (a ROS 2 bag) as they come: beside the drive itself it holds one chunk of
 * the file at most.
 *
 * @example
 * ```js
 * import { createReadStream } from 'node:fs';
 * import { DriveStream, initDrives } from 'boresight';
 *
 * await initDrives();
 * const stream = new DriveStream();
 * for await (const bytes of createReadStream('drive.mcap')) stream.push(bytes);
 * const drive = stream.finish();
 * stream.free();
 * console.log(`${drive.scans.timeS.length} scans`); // → 100 scans
 * ```
 */
export class DriveStream extends Handle<glue.DriveStream> {
  constructor(options?: ReadDriveOptions) {
    super(drives, () => new glue.DriveStream(options));
  }

  /** Takes the next bytes. */
  push(bytes: BytesInput): void {
    this.use((raw) => raw.push(bytes));
  }

  /** Ends a file; what comes next is the next part of the recording. */
  endFile(): void {
    this.use((raw) => raw.endFile());
  }

  /** The drive; what comes next is of another one. */
  finish(): Drive {
    return this.use((raw) => raw.finish() as Drive);
  }
}
