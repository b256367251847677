/** Making a calibration of the array from the frames of the open capture. */
import { batch, effect, signal } from '@preact/signals';
import type { ArrayCalibrationResult, CaptureCalibrationOptions } from 'boresight';
import { aborted, describeError, type Problem, pool } from '../../../data.ts';
import { configuredAs, type Loaded, loaded } from '../files/files.ts';
import { calibrationOptions, captureState } from '../state.ts';
import { apply, chosenArray, mending } from './in-effect.ts';
import { calibrationName, keep } from './own-calibrations.ts';

/** From all strong cells, or from the reflectors in the list. */
export type CalibrateBy = 'cells' | 'reflectors';

/** Numbers of frames. */
export interface Frames {
  used: readonly number[];
  /** Those that check it. */
  others: readonly number[];
}

/** A calibration that was made here, with what it is of. */
export interface Made {
  capture: Loaded;
  id: string;
  result: ArrayCalibrationResult;
  frames: Frames;
}

export const made = signal<Made | null>(null);
export const makingBy = signal<CalibrateBy | null>(null);
export const makeProgress = signal<{ done: number; total: number }>({ done: 0, total: 0 });
export const makeStopped = signal<CalibrateBy | null>(null);
export const makeProblem = signal<Problem | null>(null);

let running: AbortController | undefined;

export const cancelCalibration = (): void => running?.abort();

/** Which frames a calibration is made from: of one frame that is all there is. */
export function framesOf(count: number, by: 'even' | 'half' | 'all'): Frames {
  const all = Array.from({ length: count }, (_, index) => index);
  if (by === 'all' || count < 2) return { used: all, others: [] };
  const half = Math.ceil(count / 2);
  return by === 'half'
    ? { used: all.slice(0, half), others: all.slice(half) }
    : { used: all.filter((index) => index % 2 === 0), others: all.filter((index) => index % 2 === 1) };
}

/** Forgets what was made of another capture. */
export function startCalibration(): () => void {
  const stop = effect(() => {
    const capture = loaded.value;
    if (made.peek()?.capture === capture) return;
    running?.abort();
    batch(() => {
      made.value = null;
      makeStopped.value = null;
      makeProblem.value = null;
    });
  });
  return () => {
    running?.abort();
    stop();
  };
}

export async function calibrate(by: CalibrateBy): Promise<void> {
  const capture = loaded.peek();
  if (!capture) return;
  running?.abort();
  const controller = new AbortController();
  running = controller;
  const state = captureState.peek();
  batch(() => {
    makingBy.value = by;
    makeProgress.value = { done: 0, total: 0 };
    makeStopped.value = null;
    makeProblem.value = null;
  });
  const onProgress = (done: number, total: number): void => {
    if (running === controller) makeProgress.value = { done, total };
  };
  const frames = framesOf(capture.info.frames, state.calibrationFrames);
  const options: CaptureCalibrationOptions = {
    ...calibrationOptions(state, by),
    ...chosenArray(),
    frameCount: frames.used.length,
    checkFrameCount: frames.others.length,
  };
  try {
    const result = await inOrder(capture, frames, options, { signal: controller.signal, onProgress });
    const stem = capture.files.find(({ kind }) => kind === 'bin')?.name ?? 'capture';
    const own = await keep(result.calibration, calibrationName(stem));
    if (running !== controller) return;
    batch(() => {
      made.value = { capture, id: own.id, result, frames };
      apply(own);
    });
  } catch (error) {
    if (running !== controller) return;
    if (aborted(error)) makeStopped.value = by;
    else {
      const { code, message } = describeError(error);
      makeProblem.value = { code, message: message + mending(code) };
    }
  } finally {
    if (running === controller) {
      running = undefined;
      makingBy.value = null;
    }
  }
}

interface Job {
  signal: AbortSignal;
  onProgress(done: number, total: number): void;
}

/** The package takes frames one after the other, so that others come in a capture of their own: first those it is made from. */
async function inOrder(
  { bin, cfg, reading, info, kept }: Loaded,
  { used, others }: Frames,
  options: CaptureCalibrationOptions,
  job: Job,
): Promise<ArrayCalibrationResult> {
  const order = [...used, ...others];
  if (order.every((frame, at) => frame === at)) return kept.calibrateArray(options, job);
  const { frameBytes } = info.config;
  const bytes = new Uint8Array(order.length * frameBytes);
  for (const [at, frame] of order.entries())
    bytes.set(bin.subarray(frame * frameBytes, (frame + 1) * frameBytes), at * frameBytes);
  const ordered = await pool().loadCapture(bytes, configuredAs(cfg, reading), { signal: job.signal });
  try {
    return await ordered.calibrateArray(options, job);
  } finally {
    ordered.free();
  }
}
