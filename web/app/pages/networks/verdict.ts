/** Where a network is ahead of, level with or behind the classical methods, counted from a figure's values. */
import type { Figure, Line } from './figures.ts';
import { kindOf } from './methods.ts';

export interface Verdict {
  network: string;
  against: string;
  ahead: number;
  level: number;
  behind: number;
  /** Where it is farthest behind, in standard deviations of the difference. */
  worst?: { x: number; value: number; other: number };
}

/** Values closer than this many standard deviations of their difference are level. */
export const LEVEL_SIGMAS = 2;

export function compare(figure: Figure, network: Line, other: Line): Verdict {
  const verdict: Verdict = { network: network.method, against: other.method, ahead: 0, level: 0, behind: 0 };
  let farthest = 0;
  figure.x.forEach((x, i) => {
    const [a, b] = [network.values[i], other.values[i]];
    if (a == null || b == null) return;
    const sigma = Math.hypot(network.sigma[i] ?? 0, other.sigma[i] ?? 0) || Number.EPSILON;
    const lead = ((figure.lowerIsBetter ? b - a : a - b)) / sigma;
    if (lead > LEVEL_SIGMAS) verdict.ahead += 1;
    else if (lead >= -LEVEL_SIGMAS) verdict.level += 1;
    else {
      verdict.behind += 1;
      if (lead < farthest) {
        farthest = lead;
        verdict.worst = { x, value: a, other: b };
      }
    }
  });
  return verdict;
}

/** Each network of a figure against each classical method of it. */
export function verdicts(figure: Figure): { networks: Line[]; classical: Line[]; of(network: Line, other: Line): Verdict } {
  const networks = figure.lines.filter(({ method, values }) => kindOf(method) && values.some((value) => value !== null));
  const classical = figure.lines.filter(({ method, values }) => !kindOf(method) && values.some((value) => value !== null));
  return { networks, classical, of: (network, other) => compare(figure, network, other) };
}

/** The classical method that beats a network most often, and by the most there; null where none does. */
export function hardest(figure: Figure, network: Line): Verdict | null {
  const { classical } = verdicts(figure);
  const all = classical.map((other) => compare(figure, network, other)).filter(({ behind }) => behind > 0);
  const gap = ({ worst }: Verdict): number => (worst ? Math.abs(worst.value - worst.other) : 0);
  return all.sort((a, b) => b.behind - a.behind || gap(b) - gap(a))[0] ?? null;
}
