import type { BoardLogCounts } from '../generated/results.js';

/** A serial port as Web Serial has it: what of `SerialPort` is used, which TypeScript's own types do not know. */
export interface BoardPort extends EventTarget {
  readonly readable: ReadableStream<Uint8Array> | null;
  readonly writable: WritableStream<Uint8Array> | null;
  open(options: { baudRate: number; bufferSize?: number }): Promise<void>;
  close(): Promise<void>;
}

/** Whether bytes come: the port is still to be opened, open, unplugged and waited for, or no longer read. */
export type SerialState = 'opening' | 'open' | 'lost' | 'ended';

/** How a port is opened and read. */
export interface SerialOptions {
  /** Bits a second; 921600, that of a board's data port, by default. */
  baudRate?: number;
  /** Bytes the browser holds for a page that is busy; at least 65536, 262144 by default. */
  bufferSize?: number;
  /** Ends the reading; what was read until then counts. */
  signal?: AbortSignal;
  /** Whether an unplugged port is waited for; otherwise its loss is the error `port-lost`. */
  reconnect?: boolean;
  /** Called when the state or a count of errors has changed. */
  onChange?: (source: { readonly state: SerialState; readonly counts: SerialCounts }) => void;
}

/** What came over a port, and what went wrong on the way. */
export interface SerialCounts {
  bytes: number;
  /** Bytes whose stop bit was missing: noise on the line, or another speed. */
  framingErrors: number;
  parityErrors: number;
  /** The line was held low. */
  breaks: number;
  /** Bytes came faster than they were taken, and some are lost. */
  overruns: number;
  /** Errors of another name. */
  otherErrors: number;
  /** How often the port was unplugged. */
  losses: number;
}

/** How a configuration is sent. */
export interface ConfigurationOptions {
  /** Bits a second; 115200, that of a board's command port, by default. */
  baudRate?: number;
  /** How long a board may take to answer a line, ms; 5000 by default. */
  timeoutMs?: number;
  signal?: AbortSignal;
  /** Called with each line once it was answered. */
  onLine?: (line: SentLine) => void;
}

/** A line of a configuration that a board has taken. */
export interface SentLine {
  /** In the text, from 1. */
  number: number;
  command: string;
  /** What the board said, without echo and prompt. */
  answer: string;
  /** Lines sent so far, and in all. */
  sent: number;
  total: number;
}

/** At which pace a file is handed on. */
export interface ReplayOptions {
  /** Times the speed of `bytesPerSecond`; 1 by default, `Infinity` as fast as bytes are taken. */
  rate?: number;
  /** 92160 by default: 921600 bits a second, ten bits a byte. */
  bytesPerSecond?: number;
  /** Most bytes of a piece; 4096 by default. */
  pieceBytes?: number;
  signal?: AbortSignal;
}

/** What came of a board's bytes so far. */
export interface BoardCounts extends BoardLogCounts {
  bytes: number;
  frames: number;
  /** Numbers that were passed over between frames. */
  missedFrames: number;
  /** How often numbers began anew: the board was started again. */
  restarts: number;
}

/** How much is kept. */
export interface RecentOptions {
  /** How far back bytes are kept, s; 60 by default. */
  seconds?: number;
  /** Most bytes kept; 64 MiB by default. */
  bytes?: number;
}

/** What is kept of a stream, and what is not any more. */
export interface RecentCounts {
  bytes: number;
  /** From the oldest piece to the newest. */
  seconds: number;
  forgottenBytes: number;
}

/** How a bridge is read. */
export interface BridgeOptions {
  /** Ends the reading, without an error. */
  signal?: AbortSignal;
  /** Called when the bridge has said something. */
  onChange?: (frames: {
    readonly hello: BridgeHello | null;
    readonly counts: Readonly<BridgeCounts>;
    readonly skippedFrames: number;
  }) => void;
}

/** What a bridge says of itself. */
export interface BridgeHello {
  version: number;
  frameBytes: number;
  frameIntervalS: number;
  /** The text of the board's configuration. */
  config: string;
}

/** What came from a capture card, and what did not. */
export interface BridgeCounts {
  /** Packets, each once. */
  packets: number;
  bytes: number;
  lostPackets: number;
  lostBytes: number;
  /** Packets that came after a later one. */
  reordered: number;
  duplicates: number;
  /** Packets that no card sends. */
  malformed: number;
  /** How often the card began anew. */
  restarts: number;
  frames: number;
  /** Frames that lack bytes and were dropped. */
  damagedFrames: number;
}

/** A frame of raw samples. */
export interface BridgeFrame {
  /** From 0 since the card was started. */
  number: number;
  bytes: Uint8Array<ArrayBuffer>;
}
