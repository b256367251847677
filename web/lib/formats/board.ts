import * as glue from '../../wasm/boresight.js';
import { Handle } from '../runtime/handle.js';
import { call, core } from '../runtime/instance.js';
import type { BoardFrame, BoardLog, BoardLogCounts, BytesInput, ConfigInput } from '../types.js';

/**
 * Reads a recording of a board's data port (`.dat`). Damage is counted, not an error. With the
 * board's configuration Doppler bins become range rates.
 */
export function parseBoardLog(bytes: BytesInput, config?: ConfigInput): BoardLog {
  return call(() => glue.parseBoardLog(bytes, config) as BoardLog);
}

/** Takes the bytes of a board's data port as they come. */
export class BoardLogStream extends Handle<glue.BoardLogStream> {
  constructor(config?: ConfigInput) {
    super(core, () => new glue.BoardLogStream(config));
  }

  /** Takes the next bytes and gives the packets they complete. */
  push(bytes: BytesInput): BoardFrame[] {
    return this.use((raw) => raw.push(bytes) as BoardFrame[]);
  }

  /** Ends the input and gives what was still held back. */
  finish(): BoardFrame[] {
    return this.use((raw) => raw.finish() as BoardFrame[]);
  }

  /** What was skipped or damaged so far. */
  counts(): BoardLogCounts {
    return this.use((raw) => raw.counts() as BoardLogCounts);
  }
}
