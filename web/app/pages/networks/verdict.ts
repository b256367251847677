/** Where a network is ahead of, level with or behind the classical methods, counted from a figure's values. */
import { aoaFigures, doaFigures, type Figure, type Line } from './figures.ts';
import { kindOf } from './methods.ts';
import type { Results } from './results.ts';

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

/** How far a network is ahead at a condition, in standard deviations of the difference; null where one has no value. */
export function leadAt(figure: Figure, network: Line, other: Line, i: number): number | null {
  const [a, b] = [network.values[i], other.values[i]];
  if (a == null || b == null) return null;
  const sigma = Math.hypot(network.sigma[i] ?? 0, other.sigma[i] ?? 0) || Number.EPSILON;
  return (figure.lowerIsBetter ? b - a : a - b) / sigma;
}

export function compare(figure: Figure, network: Line, other: Line): Verdict {
  const verdict: Verdict = { network: network.method, against: other.method, ahead: 0, level: 0, behind: 0 };
  let farthest = 0;
  figure.x.forEach((x, i) => {
    const lead = leadAt(figure, network, other, i);
    if (lead === null) return;
    if (lead > LEVEL_SIGMAS) verdict.ahead += 1;
    else if (lead >= -LEVEL_SIGMAS) verdict.level += 1;
    else {
      verdict.behind += 1;
      if (lead < farthest) {
        farthest = lead;
        verdict.worst = { x, value: network.values[i] as number, other: other.values[i] as number };
      }
    }
  });
  return verdict;
}

/** Each network of a figure against each classical method of it. */
export function verdicts(figure: Figure): {
  networks: Line[];
  classical: Line[];
  of(network: Line, other: Line): Verdict;
} {
  const networks = figure.lines.filter(
    ({ method, values }) => kindOf(method) && values.some((value) => value !== null),
  );
  const classical = figure.lines.filter(
    ({ method, values }) => !kindOf(method) && values.some((value) => value !== null),
  );
  return { networks, classical, of: (network, other) => compare(figure, network, other) };
}

/** The classical method that beats a network most often, and by the most there; null where none does. */
export function hardest(figure: Figure, network: Line): Verdict | null {
  const { classical } = verdicts(figure);
  const all = classical.map((other) => compare(figure, network, other)).filter(({ behind }) => behind > 0);
  const gap = ({ worst }: Verdict): number => (worst ? Math.abs(worst.value - worst.other) : 0);
  return all.sort((a, b) => b.behind - a.behind || gap(b) - gap(a))[0] ?? null;
}

/** What a network is judged by at a glance: one figure of its paper, over all its conditions. */
export interface Summary {
  figure: string;
  against: string;
  behind: number;
  conditions: number;
}

/**
 * The classical method that beats a network in most conditions of its main figure; `against` is empty where none does.
 */
export function summary({ aoa, doa }: Results, network: string): Summary | null {
  const figures: (Figure | undefined)[] = [
    ...(aoa
      ? [...new Set(aoa.conditions.map(({ snrDb }) => snrDb))].map((snr) =>
          aoaFigures(aoa, snr).find(({ name }) => name === 'f1'),
        )
      : []),
    ...(doa
      ? (['apart', 'together'] as const).flatMap((range) =>
          doaFigures(doa, range, 0).filter(({ name }) => name === 'success' || name === 'counting'),
        )
      : []),
    ...(doa ? doaFigures(doa, 'apart', 0).filter(({ name }) => name === 'rounded') : []),
  ];
  const mine = figures.flatMap((figure) => {
    const line = figure?.lines.find(
      ({ method, values }) => method === network && values.some((value) => value !== null),
    );
    return figure && line ? [{ figure, line }] : [];
  });
  const [first] = mine;
  if (!first) return null;
  // A network for one target is in no figure of two.
  const same = mine.filter(({ figure }) => figure.name === first.figure.name);
  const behind = new Map<string, number>();
  let conditions = 0;
  for (const { figure, line } of same) {
    conditions += line.values.filter((value) => value !== null).length;
    for (const other of verdicts(figure).classical)
      behind.set(other.method, (behind.get(other.method) ?? 0) + compare(figure, line, other).behind);
  }
  const [against, most] = [...behind].sort((a, b) => b[1] - a[1])[0] ?? ['', 0];
  return { figure: first.figure.title, against: most ? against : '', behind: most, conditions };
}
