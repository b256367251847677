/** The moment that is shown, and playing on from it. */
import { computed, effect, signal } from '@preact/signals';
import { mountingState } from '../state.ts';
import { loaded, scans } from './drive.ts';

/** Time on the clock of the drive, s. */
export const time = signal(0);
export const playing = signal(false);

/** The radar's frame at that time, counted among its own. */
export const frame = computed(() => Math.max(after(scans.value.timeS, time.value) - 1, 0));

/** How many times are not later than `t`. */
export function after(times: ArrayLike<number>, t: number): number {
  let [low, high] = [0, times.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if ((times[middle] as number) <= t) low = middle + 1;
    else high = middle;
  }
  return low;
}

export function showFrame(index: number): void {
  const { timeS } = scans.peek();
  if (timeS.length) time.value = timeS[Math.min(Math.max(index, 0), timeS.length - 1)] as number;
}

/** Steps by frames; stops playing. */
export function step(by: number): void {
  playing.value = false;
  showFrame(frame.peek() + by);
}

export function togglePlaying(): void {
  const { timeS } = scans.peek();
  if (!playing.peek() && frame.peek() >= timeS.length - 1) showFrame(0);
  playing.value = timeS.length > 1 && !playing.peek();
}

/** A moment worth seeing: the car turns at speed. */
export function telling(): number {
  const drive = loaded.peek()?.drive;
  const { timeS } = scans.peek();
  if (!drive || !timeS.length) return 0;
  const { timeS: at, yawRateDegps, speedMps } = drive.motion;
  let best = timeS[timeS.length >> 1] as number;
  let most = 0;
  for (let i = 0; i < at.length; i++) {
    const inside = (at[i] as number) >= (timeS[0] as number) && (at[i] as number) <= (timeS.at(-1) as number);
    const speed = Number.isFinite(speedMps[i]) ? Math.min(Math.abs(speedMps[i] as number), 15) : 1;
    const turn = Math.min(Math.abs(yawRateDegps[i] as number), 10) * speed;
    if (inside && turn > most) [best, most] = [at[i] as number, turn];
  }
  return best;
}

/** Runs the clock while playing. */
export function start(): () => void {
  let request = 0;
  const stop = effect(() => {
    cancelAnimationFrame(request);
    if (!playing.value) return;
    const speed = Number(mountingState.value.speed);
    let last = performance.now();
    const tick = (now: number): void => {
      const { timeS } = scans.peek();
      const end = timeS.at(-1) ?? 0;
      time.value = Math.min(time.peek() + ((now - last) / 1000) * speed, end);
      last = now;
      if (time.peek() >= end) playing.value = false;
      else request = requestAnimationFrame(tick);
    };
    request = requestAnimationFrame(tick);
  });
  return () => {
    playing.value = false;
    cancelAnimationFrame(request);
    stop();
  };
}
