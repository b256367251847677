/** What is live now: a board, a recording in its place, or raw frames of a bridge. One at a time; the latest wins. */
import { batch, signal } from '@preact/signals';
import {
  type BoardCounts,
  type BoardFrame,
  type BridgeCounts,
  type FrameResult,
  RecentBytes,
  type RecentCounts,
  type SerialBytes,
  type SerialCounts,
  type SerialState,
} from 'boresight';
import { download, fileName } from '../../../plots/save.ts';
import { api, describeError, type Problem, pool } from '../../data.ts';
import { announce } from '../../state/announce.ts';
import { ports } from './ports.ts';
import { profile } from './profile.ts';
import { bridgeAddress, chainOptions, liveState } from './state.ts';

export type Kind = 'board' | 'replay' | 'bridge';

/** What runs, or ran last. */
export interface Live {
  kind: Kind;
  /** Of files or ports. */
  name: string;
  state: SerialState;
  begunAt: number;
  /** Of a replay: how much of it has come. */
  share: number | null;
}

export interface LiveCounts {
  board: BoardCounts | null;
  line: Readonly<SerialCounts> | null;
  recent: RecentCounts | null;
  bridge: Readonly<BridgeCounts> | null;
  /** Raw frames that were processed, and those passed over since processing was slower. */
  processed: number;
  skipped: number;
}

/** A raw frame, processed. */
export interface RawShown {
  number: number;
  view: FrameResult;
  config: string;
}

export const live = signal<Live | null>(null);
export const counts = signal<LiveCounts | null>(null);
export const frame = signal<BoardFrame | null>(null);
export const raw = signal<RawShown | null>(null);
export const liveProblem = signal<Problem | null>(null);
/** Frames are counted and kept, and not shown. */
export const paused = signal(false);

/** Between two pictures, ms: what comes faster is not seen. */
const SHOW_MS = 33;
/** Of what is kept without an end. */
const MOST_KEPT = 256 * 2 ** 20;

interface Running {
  controller: AbortController;
  source: SerialBytes | null;
  counts(): LiveCounts;
}
let running: Running | null = null;
let recent: RecentBytes | null = null;
let timer: ReturnType<typeof setTimeout> | undefined;
/** What is shown next. */
let next: { frame?: BoardFrame; raw?: RawShown } = {};

/** Shows what has come, at once or soon. */
function show(now = false): void {
  if (!now) {
    timer ??= setTimeout(() => show(true), SHOW_MS);
    return;
  }
  clearTimeout(timer);
  timer = undefined;
  batch(() => {
    if (running) counts.value = running.counts();
    if (paused.peek()) return;
    if (next.frame) frame.value = next.frame;
    if (next.raw) raw.value = next.raw;
    next = {};
  });
}

const patch = (change: Partial<Live>): void => {
  const before = live.peek();
  if (before) live.value = { ...before, ...change };
};

/** Ends what runs; what it came to stays shown. */
export function stop(): void {
  running?.controller.abort();
}

export function togglePause(): void {
  paused.value = !paused.peek();
  announce(paused.peek() ? 'Paused. Frames are counted and kept on.' : 'Going on.');
  show(true);
}

/** Runs a source to its end, in place of what ran before. */
async function run(
  begin: { kind: Kind; name: string },
  work: (running: Running) => Promise<void>,
  count: () => LiveCounts,
): Promise<void> {
  stop();
  const mine: Running = { controller: new AbortController(), source: null, counts: count };
  running = mine;
  batch(() => {
    live.value = { ...begin, state: 'opening', begunAt: performance.now(), share: null };
    [frame.value, raw.value, liveProblem.value, paused.value] = [null, null, null, false];
    next = {};
  });
  show(true);
  try {
    await work(mine);
  } catch (error) {
    if (running === mine && !mine.controller.signal.aborted) liveProblem.value = describeError(error);
  } finally {
    // What runs now is another.
    if (running === mine) {
      show(true);
      running = null;
      patch({ state: 'ended' });
      announce(endOf(count()));
    }
  }
}

function endOf({ board, processed }: LiveCounts): string {
  return board
    ? `Ended after ${board.frames} frames; ${board.damagedPackets} packets were damaged and ${board.missedFrames} frames missed.`
    : `Ended after ${processed} frames.`;
}

const keeping = (): RecentBytes =>
  new RecentBytes(
    liveState.peek().keep === 'minute'
      ? { seconds: 60, bytes: MOST_KEPT }
      : { seconds: Number.POSITIVE_INFINITY, bytes: MOST_KEPT },
  );

async function runBoard(
  begin: { kind: Kind; name: string },
  open: (running: Running, kept: RecentBytes) => AsyncIterable<Uint8Array>,
): Promise<void> {
  const kept = keeping();
  recent = kept;
  let line: SerialBytes | null = null;
  let frames: ReturnType<typeof api.boardFrames> | null = null;
  const count = (): LiveCounts => ({
    board: frames?.counts ?? null,
    line: line?.counts ?? null,
    recent: kept.counts,
    bridge: null,
    processed: frames?.counts.frames ?? 0,
    skipped: 0,
  });
  const work = async (mine: Running): Promise<void> => {
    const source = kept.of(open(mine, kept));
    line = mine.source;
    // A configuration that cannot be read says nothing of rates; its field says why.
    frames = api.boardFrames(source, usable(profile.peek()?.text));
    for await (const one of frames) {
      if (running !== mine) return;
      // Of a packet that the end cut some parts are missing, which the one before has.
      if (one.complete || mine.counts().processed < 2) next.frame = one;
      show();
    }
  };
  await run(begin, work, count);
}

function usable(text: string | undefined): string | undefined {
  if (!text) return undefined;
  try {
    api.parseConfig(text);
    return text;
  } catch {
    return undefined;
  }
}

/** Reads the data port. */
export function connect(): void {
  const data = ports.peek().data;
  if (!data) return;
  void runBoard({ kind: 'board', name: data.name }, (mine) => {
    mine.source = api.serialBytes(data.port, {
      baudRate: liveState.peek().dataBaud,
      signal: mine.controller.signal,
      onChange: ({ state }) => {
        if (running !== mine) return;
        if (state !== live.peek()?.state && state === 'lost')
          announce('The board was unplugged. Plug it in again, or choose another port.');
        patch({ state });
        show();
      },
    });
    return mine.source;
  });
}

/** Goes on with another data port, where one is read. */
export function changePort(): void {
  const data = ports.peek().data;
  if (!data || !running?.source) return;
  running.source.usePort(data.port);
  patch({ name: data.name });
}

/** A recording in place of a board, over the same way. */
export function replay(file: { name: string; data: Blob | Uint8Array }): void {
  const size = file.data instanceof Blob ? file.data.size : file.data.length;
  void runBoard({ kind: 'replay', name: file.name }, (mine) => {
    const { pace } = liveState.peek();
    const signal = mine.controller.signal;
    const rate = { recorded: 1, port: 1, ten: 10, fast: Number.POSITIVE_INFINITY }[pace];
    const own = pace === 'recorded' && file.data instanceof Uint8Array ? recordedPace(file.data) : null;
    const source = api.replayBytes(file.data, { rate, signal, ...(own ? { bytesPerSecond: own } : {}) });
    patch({ state: 'open' });
    return told(source, size, mine);
  });
}

/** Tells how much of a file has come. */
async function* told(source: AsyncIterable<Uint8Array>, size: number, mine: Running): AsyncGenerator<Uint8Array> {
  let at = 0;
  for await (const bytes of source) {
    at += bytes.length;
    if (running === mine) patch({ share: at / size });
    yield bytes;
  }
}

/** Bytes a second that a recording came at, by its frames and the time from one to the next; null where that is not known. */
function recordedPace(bytes: Uint8Array): number | null {
  const text = usable(profile.peek()?.text);
  if (!text) return null;
  const { frames } = api.parseBoardLog(bytes);
  const { frameIntervalS } = api.parseConfig(text).waveform;
  return frames.length && frameIntervalS > 0 ? bytes.length / (frames.length * frameIntervalS) : null;
}

/** Raw frames of a bridge, each by the chain on a worker; those that come meanwhile are passed over. */
export function connectBridge(): void {
  const address = bridgeAddress(liveState.peek());
  const stopping = new AbortController();
  const frames = api.bridgeFrames(address, { signal: stopping.signal, onChange: () => show() });
  let processed = 0;
  const count = (): LiveCounts => ({
    board: null,
    line: null,
    recent: null,
    bridge: frames.counts,
    processed,
    skipped: frames.skippedFrames,
  });
  const work = async (mine: Running): Promise<void> => {
    mine.controller.signal.addEventListener('abort', () => stopping.abort());
    for await (const { number, bytes } of frames) {
      if (running !== mine) return;
      patch({ state: 'open' });
      const config = frames.hello?.config ?? '';
      const view = await pool().processFrame(bytes, config, 0, chainOptions(liveState.peek()), {
        signal: mine.controller.signal,
      });
      for (const one of [view, ...view.detections]) one.frame = number;
      processed += 1;
      next.raw = { number, view, config };
      show();
    }
  };
  recent = null;
  void run({ kind: 'bridge', name: address }, work, count);
}

const stamp = (): string => new Date().toISOString().slice(0, 19).replaceAll(/[:T]/g, '-');

/** Saves what is kept of the data port. */
export function saveData(): void {
  if (recent) download(new Blob([recent.bytes()]), fileName(['live', stamp()], 'dat'));
}

export function saveProfile(): void {
  const text = profile.peek()?.text;
  if (text) download(new Blob([text]), fileName(['live', stamp()], 'cfg'));
}
