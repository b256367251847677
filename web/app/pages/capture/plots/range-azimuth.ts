/** Range-azimuth map of the shown frame; of all frames together, of the first. */
import { batch, computed, effect, signal } from '@preact/signals';
import type { ChainOptions, ImageFrom, RangeAzimuthMap } from 'boresight';
import { aborted, describeError, type Problem, pool } from '../../../data.ts';
import { readyNetworks } from '../../../networks/load.ts';
import { result, usedArray, withNetwork } from '../detections/process.ts';
import { type Loaded, loaded } from '../files/files.ts';
import { frameAt, playing } from '../frames/playback.ts';
import { captureState, chainOptions } from '../state.ts';

export interface ShownMap {
  capture: Loaded;
  frame: number;
  rangeM: Float64Array;
  /** Evenly spaced, from left to right. */
  azimuthDeg: Float64Array;
  /** Column by column from the left, each from near to far. */
  levelsDb: Float32Array;
  from: ImageFrom;
  /** Cells over the threshold, those not kept, and sources that fell beside the map. */
  cells: number;
  beyondLimit: number;
  outside: number;
}

export const rangeAzimuth = signal<ShownMap | null>(null);
export const rangeAzimuthProblem = signal<Problem | null>(null);
export const rangeAzimuthWorking = signal(false);
/** Cells whose angles are estimated, while that takes a while. */
export const rangeAzimuthProgress = signal<{ done: number; total: number } | null>(null);
/** Whether the user ended it: until settings change it rests. */
export const rangeAzimuthStopped = signal(false);
/** Strongest level of the frames seen under these settings: colours stay while frames play. */
export const rangeAzimuthTopDb = signal(Number.NEGATIVE_INFINITY);

/** What a board on a bench sees to either side. */
export const FIELD_DEG = 75;
const STEP_DEG = 0.5;
/** As many as the bird's-eye view takes. */
const MOST_CELLS = 4096;
/** Of frames, that playing again shows at once. */
const MOST_KEPT = 64;

/** A bar that only flashes tells nothing. */
const SOON_MS = 300;

let known = new Map<number, ShownMap>();
let running: AbortController | undefined;

export function cancelRangeAzimuth(): void {
  running?.abort();
  running = undefined;
  batch(() => {
    playing.value = false;
    rangeAzimuthStopped.value = true;
    rangeAzimuthProgress.value = null;
    rangeAzimuthWorking.value = false;
  });
}

export function resumeRangeAzimuth(): void {
  rangeAzimuthStopped.value = false;
}

const wanted = computed(() => {
  const geometry = usedArray.value;
  const { tx, rx } = geometry ?? {};
  if (!tx || !rx) return null;
  const { networks } = captureState.value;
  // Every cell over the threshold, and not the peaks alone: an image has an extent.
  const chain = { ...chainOptions(captureState.value), peakGrouping: false, maxDetections: MOST_CELLS };
  return JSON.stringify({ chain, array: { tx, rx }, networks });
});
const shownCapture = computed(() => (result.value?.capture === loaded.value ? loaded.value : null));

export function startRangeAzimuth(): () => void {
  const frame = computed(frameAt);
  let before: readonly unknown[] = [];
  const stop = effect(() => {
    const [capture, options] = [shownCapture.value, wanted.value];
    void frame.value;
    void rangeAzimuthStopped.value;
    const now = [capture, options, readyNetworks.value];
    if (now.some((one, i) => one !== before[i])) {
      before = now;
      forget();
    }
    // A frame under way is finished first: while frames play, each would else end the one before.
    if (capture && options && !running && !rangeAzimuthStopped.peek())
      queueMicrotask(() => void follow(capture, options));
  });
  return () => {
    forget();
    stop();
  };
}

/** What is known is of another capture, or of other settings. */
function forget(): void {
  running?.abort();
  running = undefined;
  known = new Map();
  batch(() => {
    rangeAzimuth.value = null;
    rangeAzimuthProblem.value = null;
    rangeAzimuthWorking.value = false;
    rangeAzimuthProgress.value = null;
    rangeAzimuthStopped.value = false;
    rangeAzimuthTopDb.value = Number.NEGATIVE_INFINITY;
  });
}

async function follow(capture: Loaded, options: string): Promise<void> {
  if (running || shownCapture.peek() !== capture || wanted.peek() !== options) return;
  const controller = new AbortController();
  running = controller;
  const current = (): boolean => running === controller;
  rangeAzimuthWorking.value = true;
  try {
    for (let frame = frameAt(); rangeAzimuth.peek()?.frame !== frame; frame = frameAt()) {
      const made = known.get(frame) ?? (await mapOf(capture, frame, options, controller));
      if (!current()) return;
      known.delete(frame);
      known.set(frame, made);
      for (const oldest of known.keys()) {
        if (known.size <= MOST_KEPT) break;
        known.delete(oldest);
      }
      let top = rangeAzimuthTopDb.peek();
      for (const level of made.levelsDb) if (level > top) top = level;
      batch(() => {
        rangeAzimuthProblem.value = null;
        rangeAzimuthTopDb.value = top;
        rangeAzimuth.value = made;
      });
    }
  } catch (error) {
    if (current() && !aborted(error)) {
      batch(() => {
        rangeAzimuth.value = null;
        rangeAzimuthProblem.value = describeError(error);
      });
    }
  } finally {
    if (current()) {
      running = undefined;
      rangeAzimuthProgress.value = null;
      rangeAzimuthWorking.value = false;
    }
  }
}

async function mapOf(capture: Loaded, frame: number, wanted: string, controller: AbortController): Promise<ShownMap> {
  const { signal } = controller;
  const began = performance.now();
  const onProgress = (done: number, total: number): void => {
    if (running === controller && performance.now() - began > SOON_MS) rangeAzimuthProgress.value = { done, total };
  };
  const { chain, array } = JSON.parse(wanted);
  const cells = await capture.kept.frameCells(frame, chain, { signal });
  const { waveform } = capture.info.config;
  const angle = { ...(await withNetwork(chain.angle)), fieldOfViewDeg: FIELD_DEG };
  // The cells are calibrated already.
  const { calibration: _, ...settings } = chain as ChainOptions;
  const options = { ...settings, waveform, array, angle, grid: { fieldOfViewDeg: FIELD_DEG } };
  const { map } = await pool().imageCells(cells, options, { signal, onProgress });
  const { from } = await pool().imagePlan(options, { signal });
  return {
    ...{ capture, frame, from },
    ...inDegrees(map),
    cells: cells.rangeM.length,
    beyondLimit: cells.counts.beyondLimit,
    outside: map.outside.count,
  };
}

/** The map, which is even in the azimuth's sine, with columns that are even in degrees: each the nearest. */
function inDegrees(map: RangeAzimuthMap): Pick<ShownMap, 'rangeM' | 'azimuthDeg' | 'levelsDb'> {
  const [ranges, azimuths] = map.shape;
  const columns = Math.round((2 * FIELD_DEG) / STEP_DEG) + 1;
  const azimuthDeg = Float64Array.from({ length: columns }, (_, i) => FIELD_DEG - i * STEP_DEG);
  const sine = (degrees: number): number => Math.sin((degrees * Math.PI) / 180);
  const edge = sine(map.azimuthDeg[0] as number);
  const width = sine(map.azimuthDeg[azimuths - 1] as number) - edge;
  const levelsDb = new Float32Array(columns * ranges);
  for (let i = 0; i < columns; i++) {
    const at = Math.round(((sine(azimuthDeg[i] as number) - edge) / width) * (azimuths - 1));
    const nearest = Math.min(Math.max(at, 0), azimuths - 1);
    for (let j = 0; j < ranges; j++)
      levelsDb[i * ranges + j] = 10 * Math.log10(map.power[j * azimuths + nearest] as number);
  }
  return { rangeM: map.rangeM, azimuthDeg, levelsDb };
}
