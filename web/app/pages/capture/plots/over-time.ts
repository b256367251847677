/**
 * Power over time: of each frame its range profile and its Doppler spectrum within a range gate, from the frame's
 * map as it comes from the workers. Maps are kept as far as memory allows, so that another gate is there at once.
 */
import { batch, computed, effect, signal } from '@preact/signals';
import type { ChainOptions, FrameResult } from 'boresight';
import { aborted, describeError, type Problem, WORKERS } from '../../../data.ts';
import { result } from '../detections/process.ts';
import { type Loaded, loaded } from '../files/files.ts';
import { captureState, chainOptions } from '../state.ts';

export interface FailedFrame {
  frame: number;
  problem: Problem;
}

/** What is shown: always of the open capture, whole or as far as it has come. */
export interface OverTime {
  capture: Loaded;
  /** Begin of each column's frame after that of the first, s. */
  timeS: Float64Array;
  /** Frames from a column to the next: above 1 where there are more than columns. */
  every: number;
  rangeM: Float64Array;
  rateMps: Float64Array;
  /** Power of each column over range, and over range rate within the gate, dB; not a number where none is known yet. */
  rangeDb: Float32Array;
  rateDb: Float32Array;
  /** Its ranges, once it is known. */
  gateM: readonly [number, number] | null;
  /** Columns that are done, failed ones among them. */
  done: number;
  failed: readonly FailedFrame[];
}

export const overTime = signal<OverTime | null>(null);
export const overTimeProgress = signal<{ done: number; total: number } | null>(null);
export const overTimeStopped = signal(false);

/** No canvas is wider, and no screen either. */
const MOST_COLUMNS = 8192;
/** Of a plot: powers are kept as numbers and as colours. */
const MOST_CELLS = 16_000_000;
/** What maps may take in memory; those beyond are computed anew for another gate. */
const MOST_BYTES = 64 * 2 ** 20;
/** Between two pictures of what has come so far. */
const SHOW_MS = 250;

/** Maps of a capture under some options, as far as they have come. */
interface Pass {
  capture: Loaded;
  chain: string;
  every: number;
  columns: number;
  axes: Pick<FrameResult, 'rangeM' | 'rateMps'> | null;
  rangeDb: Float32Array;
  known: Uint8Array;
  maps: Map<number, Float32Array>;
  bytes: number;
  failed: Map<number, Problem>;
  strongest: { rangeBin: number; powerDb: number } | null;
}

let pass: Pass | null = null;
let running: AbortController | undefined;
const attempts = signal(0);

export function cancelOverTime(): void {
  running?.abort();
}

export function resumeOverTime(): void {
  attempts.value += 1;
}

/** What maps depend on, as text; of detections one is enough, and no angle is looked at. */
const mapOptions = computed(() => {
  const { angle: _, ...chain } = chainOptions(captureState.value);
  return JSON.stringify({ ...chain, maxDetections: 1, angle: { method: 'bartlett' } } satisfies ChainOptions);
});
const wantedBin = computed(() => captureState.value.cell?.rangeBin ?? null);
const halfGateM = computed(() => captureState.value.gate);
/** The first results go before. */
const shownCapture = computed(() => (result.value?.capture === loaded.value ? loaded.value : null));

export function startOverTime(): () => void {
  const stop = effect(() => {
    void attempts.value;
    const capture = shownCapture.value;
    const [chain, bin, halfM] = [mapOptions.value, wantedBin.value, halfGateM.value];
    running?.abort();
    running = undefined;
    if (pass?.capture !== capture || pass?.chain !== chain) {
      pass = null;
      overTime.value = null;
    }
    overTimeStopped.value = false;
    overTimeProgress.value = null;
    if (!capture || capture.info.frames < 2) return;
    pass ??= begin(capture, chain);
    const controller = new AbortController();
    running = controller;
    const present = pass;
    queueMicrotask(() => void run(present, { bin, halfM }, controller));
  });
  return () => {
    running?.abort();
    running = undefined;
    pass = null;
    stop();
  };
}

function begin(capture: Loaded, chain: string): Pass {
  const { frames, config } = capture.info;
  const { rangePadding = 1 } = JSON.parse(chain) as ChainOptions;
  const most = Math.min(MOST_COLUMNS, Math.floor(MOST_CELLS / (config.waveform.samples * rangePadding)));
  const every = Math.ceil(frames / Math.max(most, 1));
  const columns = Math.ceil(frames / every);
  return {
    ...{ capture, chain, every, columns },
    axes: null,
    rangeDb: new Float32Array(),
    known: new Uint8Array(columns),
    maps: new Map(),
    bytes: 0,
    failed: new Map(),
    strongest: null,
  };
}

interface Gate {
  /** Its middle; null for the range of the strongest detection. */
  bin: number | null;
  halfM: number;
}

interface Bins {
  first: number;
  last: number;
}

/** Bins within the gate: one at least. */
function binsOf({ axes, strongest }: Pass, { bin, halfM }: Gate): Bins | null {
  const middle = bin ?? strongest?.rangeBin ?? (axes ? 0 : null);
  if (!axes || middle === null) return null;
  const { rangeM } = axes;
  const at = Math.min(middle, rangeM.length - 1);
  const within = (i: number): boolean =>
    i >= 0 && i < rangeM.length && Math.abs((rangeM[i] as number) - (rangeM[at] as number)) <= halfM;
  let [first, last] = [at, at];
  while (within(first - 1)) first -= 1;
  while (within(last + 1)) last += 1;
  return { first, last };
}

async function run(now: Pass, gate: Gate, controller: AbortController): Promise<void> {
  const { signal } = controller;
  const current = (): boolean => running === controller;
  let rateDb = new Float32Array();
  let bins: Bins | null = null;
  let shownAt = performance.now();
  const show = (force = false): void => {
    if (!current() || !now.axes || (!force && performance.now() - shownAt < SHOW_MS)) return;
    shownAt = performance.now();
    overTime.value = picture(now, rateDb, bins);
  };
  /** Looks at each column that lacks something, as many at once as there are workers. */
  const sweep = async (): Promise<void> => {
    let [next, swept] = [0, 0];
    const lane = async (): Promise<void> => {
      while (next < now.columns && current()) {
        const column = next++;
        if (now.failed.has(column) || (now.known[column] && !bins && gate.bin === null)) {
          swept += 1;
          continue;
        }
        const map = now.maps.get(column) ?? (await look(now, column, signal));
        if (!current()) return;
        // With the first map its axes are known, and with them a gate that was asked for.
        if (gate.bin !== null) bins ??= binsOf(now, gate);
        if (map && bins && now.axes) {
          const rates = now.axes.rateMps.length;
          if (!rateDb.length) rateDb = new Float32Array(now.columns * rates).fill(Number.NaN);
          sumOver(map, rates, bins, rateDb.subarray(column * rates, (column + 1) * rates));
        }
        swept += 1;
        overTimeProgress.value = { done: swept, total: now.columns };
        show();
      }
    };
    await Promise.all(Array.from({ length: WORKERS }, lane));
  };
  try {
    await sweep();
    if (current() && !bins) {
      bins = binsOf(now, gate);
      await sweep();
    }
  } catch (error) {
    if (!current()) return;
    if (!aborted(error)) throw error;
    overTimeStopped.value = true;
  }
  if (!current()) return;
  batch(() => {
    show(true);
    overTimeProgress.value = null;
  });
  running = undefined;
}

/** The map of a column's frame; undefined where it cannot be had, which is noted. */
async function look(now: Pass, column: number, signal: AbortSignal): Promise<Float32Array | undefined> {
  let view: FrameResult;
  try {
    const options = JSON.parse(now.chain) as ChainOptions;
    view = await now.capture.kept.processFrame(column * now.every, options, { signal });
  } catch (error) {
    if (signal.aborted) throw error;
    now.failed.set(column, describeError(error));
    now.known[column] = 1;
    return undefined;
  }
  const { rangeM, rateMps, rangeProfileDb, rangeDopplerDb, detections } = view;
  if (!now.axes) {
    now.axes = { rangeM, rateMps };
    now.rangeDb = new Float32Array(now.columns * rangeM.length).fill(Number.NaN);
  }
  now.rangeDb.set(rangeProfileDb, column * rangeM.length);
  now.known[column] = 1;
  const [found] = detections;
  if (found && found.powerDb > (now.strongest?.powerDb ?? Number.NEGATIVE_INFINITY)) now.strongest = found;
  if (now.bytes + rangeDopplerDb.byteLength <= MOST_BYTES && !now.maps.has(column)) {
    now.maps.set(column, rangeDopplerDb);
    now.bytes += rangeDopplerDb.byteLength;
  }
  return rangeDopplerDb;
}

/** Powers of the gate's ranges together, at each range rate. */
function sumOver(map: Float32Array, rates: number, { first, last }: Bins, out: Float32Array): void {
  for (let rate = 0; rate < rates; rate++) {
    let power = 0;
    for (let range = first; range <= last; range++) power += 10 ** ((map[range * rates + rate] as number) / 10);
    out[rate] = 10 * Math.log10(power);
  }
}

function picture(now: Pass, rateDb: Float32Array, bins: Bins | null): OverTime {
  const { capture, every, columns, rangeDb, failed } = now;
  const { rangeM, rateMps } = now.axes as NonNullable<Pass['axes']>;
  const interval = capture.info.config.waveform.frameIntervalS;
  return {
    ...{ capture, every, rangeM, rateMps, rangeDb, rateDb },
    timeS: Float64Array.from({ length: columns }, (_, column) => column * every * interval),
    gateM: bins && [rangeM[bins.first] as number, rangeM[bins.last] as number],
    done: now.known.reduce((sum, one) => sum + one, 0),
    failed: [...failed].map(([column, problem]) => ({ frame: column * every, problem })),
  };
}
