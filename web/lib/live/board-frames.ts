import { BoardLogStream } from '../formats/board.js';
import type { BoardFrame, BoardLogCounts, ConfigInput } from '../types.js';
import type { BoardCounts } from './types.js';

const NONE: BoardLogCounts = { skippedBytes: 0, damagedPackets: 0, warnings: [] };

/** Frames of a board as its bytes come, and what was lost. */
export class BoardFrames implements AsyncIterable<BoardFrame> {
  readonly #source: AsyncIterable<Uint8Array>;
  readonly #config: ConfigInput | undefined;
  #stream: BoardLogStream | null = null;
  #log = NONE;
  #last: number | null = null;
  #own = { bytes: 0, frames: 0, missedFrames: 0, restarts: 0 };

  /** @internal */
  constructor(source: AsyncIterable<Uint8Array>, config?: ConfigInput) {
    this.#source = source;
    this.#config = config;
  }

  get counts(): BoardCounts {
    return { ...this.#own, ...(this.#stream?.counts() ?? this.#log) };
  }

  async *[Symbol.asyncIterator](): AsyncGenerator<BoardFrame, void, undefined> {
    const stream = new BoardLogStream(this.#config);
    this.#stream = stream;
    try {
      for await (const bytes of this.#source) {
        this.#own.bytes += bytes.length;
        for (const frame of stream.push(bytes)) yield this.#take(frame);
      }
      for (const frame of stream.finish()) yield this.#take(frame);
    } finally {
      this.#log = stream.counts();
      this.#stream = null;
      stream.free();
    }
  }

  #take(frame: BoardFrame): BoardFrame {
    const passed = this.#last === null ? 0 : frame.frameNumber - this.#last - 1;
    if (passed > 0) this.#own.missedFrames += passed;
    else if (passed < 0) this.#own.restarts += 1;
    this.#last = frame.frameNumber;
    this.#own.frames += 1;
    return frame;
  }
}

/**
 * Frames of a board's data port from its bytes, live ({@link serialBytes}), of a file ({@link replayBytes}) or of one's own.
 * With the configuration that the board runs Doppler bins become range rates. Damage is counted, not an error.
 *
 * @example
 * ```js
 * import { boardFrames, init, replayBytes } from 'boresight';
 * import { readFile } from 'node:fs/promises';
 *
 * await init();
 * const dat = await readFile('board.dat');
 * const frames = boardFrames(replayBytes(dat, { rate: Infinity }));
 * let objects = 0;
 * for await (const frame of frames) objects += frame.objects.length;
 * console.log(frames.counts.frames, frames.counts.missedFrames); // → 250 0
 * ```
 */
export function boardFrames(source: AsyncIterable<Uint8Array>, config?: ConfigInput): BoardFrames {
  return new BoardFrames(source, config);
}
