/** Times of calls: the median and quartiles of several, after calls that are not counted. */

/** Duration of one call, milliseconds. */
export interface Spread {
  median: number;
  low: number;
  high: number;
  calls: number;
}

/** Calls before those counted: the first ones compile code and fill caches. */
export const WARM_UP = 2;

export interface Effort {
  /** Calls go on for this long, at least `fewest` and at most `most` times. */
  budgetMs: number;
  fewest: number;
  most: number;
  /** Calls already made. */
  warm?: number;
}

export async function measure(
  call: () => Promise<unknown>,
  signal: AbortSignal,
  { budgetMs, fewest, most, warm = 0 }: Effort,
  report: (share: number) => void = () => {},
): Promise<Spread> {
  for (let i = warm; i < WARM_UP; i++) await call();
  const times: number[] = [];
  const started = performance.now();
  while (times.length < fewest || (times.length < most && performance.now() - started < budgetMs)) {
    signal.throwIfAborted();
    const before = performance.now();
    await call();
    times.push(performance.now() - before);
    report(Math.min(Math.max(times.length / most, (performance.now() - started) / budgetMs), 1));
  }
  times.sort((a, b) => a - b);
  const at = (share: number): number => times[Math.min(Math.floor(share * times.length), times.length - 1)] as number;
  return { median: at(0.5), low: at(0.25), high: at(0.75), calls: times.length };
}
