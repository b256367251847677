/** Which frame is shown, and playing on from it. */

import { signal } from '@preact/signals';
import { frameKeys } from '../../../../plots/frame-keys.ts';
import { loaded } from '../files/files.ts';
import { captureState, update } from '../state.ts';

export const playing = signal(false);

/** The frame that is shown, kept within the capture; of all frames together the first. */
export function frameAt(): number {
  const { frame } = captureState.value;
  return frame === 'all' ? 0 : Math.min(frame, Math.max(frames() - 1, 0));
}

const frames = (): number => loaded.value?.info.frames ?? 0;

/** Shows a frame, or the nearest there is; playing ends. */
export function showFrame(wanted: number): void {
  playing.value = false;
  update({ frame: Math.min(Math.max(Math.round(wanted), 0), Math.max(frames() - 1, 0)) });
}

/** Steps by frames; all frames together go over to the first. */
export function step(by: number): void {
  showFrame(captureState.peek().frame === 'all' ? 0 : frameAt() + by);
}

export function togglePlaying(): void {
  playing.value = frames() > 1 && !playing.value;
}

/** One frame on, and from the last to the first. */
export function playOn(): void {
  update({ frame: captureState.peek().frame === 'all' ? 0 : (frameAt() + 1) % frames() });
}

/** Keys that all plots over time share. */
export const frameKey = frameKeys(togglePlaying, step);
