/** What networks are for, and how the best of each task stands against all classical methods, counted from the figures. */
import { aoaFigures, doaFigures, type Figure } from './figures.ts';
import type { Results } from './results.ts';
import { LEVEL_SIGMAS, leadAt, verdicts } from './verdict.ts';

/** The conditions of a task, by what the best classical method does there. */
export interface Standing {
  network: string;
  ahead: number;
  level: number;
  behind: number;
  /** Who is ahead of it most often; empty where nobody is. */
  rival: string;
}

export interface Task {
  name: string;
  title: string;
  /** By which figure it is judged. */
  by: string;
  figures(results: Results): (Figure | undefined)[];
}

const ofRegions =
  (name: string, ranges: readonly ('apart' | 'together')[]) =>
  ({ doa }: Results): (Figure | undefined)[] =>
    doa ? ranges.map((range) => doaFigures(doa, range, 0).find((figure) => figure.name === name)) : [];

export const TASKS: readonly Task[] = [
  {
    name: 'snapshot',
    title: 'Angles and powers of 2 to 10 targets in one snapshot, their number unknown',
    by: 'F1',
    figures: ({ aoa }) =>
      aoa
        ? [...new Set(aoa.conditions.map(({ snrDb }) => snrDb))].map((snr) =>
            aoaFigures(aoa, snr).find(({ name }) => name === 'f1'),
          )
        : [],
  },
  {
    name: 'counting',
    title: 'Whether a region of a data cube holds no, one or two targets',
    by: 'share counted rightly',
    figures: ofRegions('counting', ['apart', 'together']),
  },
  {
    name: 'one',
    title: 'In which whole degree the one target of a region lies',
    by: 'error after rounding; it knows that targets stand at whole degrees within 10°',
    figures: ofRegions('rounded', ['apart']),
  },
  {
    name: 'two',
    title: 'In which whole degrees the two targets of a region lie',
    by: 'share within 1°; it knows that targets stand at whole degrees within 10°',
    figures: ofRegions('success', ['apart', 'together']),
  },
];

/** The network of a task that is ahead most often and behind least; null where there are no figures. */
export function standing(task: Task, results: Results): Standing | null {
  const all = new Map<string, { of: Standing; rivals: Map<string, number> }>();
  for (const figure of task.figures(results)) {
    if (!figure) continue;
    const { networks, classical } = verdicts(figure);
    for (const network of networks) {
      // Refined, an answer is in good part that of the pursuit which refines it.
      if (/refined/.test(network.method)) continue;
      const { of, rivals } = all.get(network.method) ?? {
        of: { network: network.method, ahead: 0, level: 0, behind: 0, rival: '' },
        rivals: new Map<string, number>(),
      };
      all.set(network.method, { of, rivals });
      for (const i of figure.x.keys()) {
        if (network.values[i] == null) continue;
        const leads = classical.map((other) => [other.method, leadAt(figure, network, other, i) ?? Infinity] as const);
        const better = leads.filter(([, lead]) => lead < -LEVEL_SIGMAS);
        for (const [method] of better) rivals.set(method, (rivals.get(method) ?? 0) + 1);
        of[better.length ? 'behind' : leads.every(([, lead]) => lead > LEVEL_SIGMAS) ? 'ahead' : 'level'] += 1;
      }
    }
  }
  const [best] = [...all.values()].sort((a, b) => b.of.ahead - b.of.behind - (a.of.ahead - a.of.behind));
  if (!best) return null;
  return { ...best.of, rival: [...best.rivals].sort((a, b) => b[1] - a[1])[0]?.[0] ?? '' };
}
