/** The papers' figures from the experiments' results: a line a method over a condition, and how sure each value is. */
import { count, fixed } from '../../../plots/format.ts';
import type { AoaReport, DoaReport, DoaResult, Operating } from './results.ts';

export interface Line {
  /** As the experiment names it. */
  method: string;
  values: (number | null)[];
  /** Standard deviation of each value, as the number of trials leaves it. */
  sigma: (number | null)[];
}

export interface Figure {
  name: string;
  title: string;
  detail: string;
  xLabel: string;
  xSteps: number[];
  /** One condition of the abscissa in words: `at 6 targets`. */
  at(x: number): string;
  x: number[];
  yLabel: string;
  /** Drawn as logarithms. */
  log?: boolean;
  y: readonly [number, number];
  lowerIsBetter: boolean;
  lines: Line[];
  /** Lines that are no method. */
  bounds?: { name: string; values: (number | null)[] }[];
  show(value: number): string;
  /** Column of the CSV. */
  unit: string;
  remark: string;
}

const sum = (values: readonly number[]): number => values.reduce((a, b) => a + b, 0);
/** Of a share `p` of `n` trials; a share of 0 or 1 is not certain either. */
const binomial = (p: number, n: number): number => {
  const held = (p * n + 1) / (n + 2);
  return Math.sqrt((held * (1 - held)) / Math.max(n, 1));
};
const present = (value: number | null | undefined): number | null =>
  value === null || value === undefined || !Number.isFinite(value) ? null : value;

type Result = AoaReport['conditions'][number]['methods'][number];

/** Over the number of targets, at one SNR. */
export function aoaFigures(report: AoaReport, snrDb: number): Figure[] {
  const conditions = report.conditions.filter((one) => one.snrDb === snrDb).sort((a, b) => a.targets - b.targets);
  const x = conditions.map(({ targets }) => targets);
  const line = (value: (of: Result, targets: number) => [number | null, number | null]): Line[] =>
    report.methods.map((method, i) => {
      const pairs = conditions.map((one) => {
        const of = one.methods[i];
        return of ? value(of, one.targets) : [null, null];
      });
      return { method, values: pairs.map(([a]) => a ?? null), sigma: pairs.map(([, b]) => b ?? null) };
    });
  const shared = {
    xLabel: 'Targets in the snapshot',
    xSteps: [1, 2, 5],
    x,
    at: (targets: number) => `${targets} targets`,
    lowerIsBetter: true,
    detail: `${report.array}, ${snrDb} dB`,
  };
  const trials = `${count(report.trials)} snapshots a condition.`;
  const missing = (
    name: string,
    title: string,
    score: string,
    scored: (of: Result) => { f1: number } | null,
    remark: string,
  ): Figure => ({
    ...shared,
    name,
    title,
    yLabel: `1 − ${score}`,
    log: true,
    y: [0.0001, 0.5],
    unit: 'one_minus_f1',
    lines: line((of, targets) => {
      const found = scored(of);
      return found ? [1 - found.f1, binomial(found.f1, report.trials * targets)] : [null, null];
    }),
    show: (value) => `F1 ${fixed(1 - value, 4)}`,
    remark: `${remark} ${trials}`,
  });
  return [
    missing(
      'f1',
      'F1: what is missing',
      'largest F1',
      ({ best }) => best,
      'Right is what lies within 0.5° of a target; the threshold is the best for each method and condition.',
    ),
    missing(
      'f1-at-one-threshold',
      'F1 at one threshold: what is missing',
      'F1',
      ({ atOneThreshold }) => atOneThreshold,
      `Each method has one threshold for all conditions, from ${count(report.validation)} other snapshots of each.`,
    ),
    {
      ...shared,
      name: 'bound',
      title: 'Angle error against the bound',
      yLabel: 'RMSE over CRB',
      log: true,
      y: [0.9, 20],
      unit: 'rmse_over_crb',
      lines: line(({ separated: { rmseDeg, boundDeg, found } }) => {
        const ratio = rmseDeg === null || !boundDeg ? null : present(rmseDeg / boundDeg);
        return [ratio, ratio === null ? null : ratio / Math.sqrt(2 * Math.max(found, 1))];
      }),
      show: (value) => `${fixed(value, 2)} × CRB`,
      remark: `Over targets found that stand two beam widths apart from all others; 1 is the Cramér–Rao bound. ${trials}`,
    },
    {
      ...shared,
      name: 'power',
      title: 'Power error',
      yLabel: 'Mean absolute error (dB)',
      y: [0, 2],
      unit: 'power_error_db',
      lines: line(({ best }, targets) => {
        const error = present(best?.powerErrorDb);
        // Of a mean of absolute values of a normal quantity.
        return [error, error === null ? null : (0.756 * error) / Math.sqrt(Math.max(report.trials * targets, 1))];
      }),
      show: (value) => `${fixed(value, 2)}\u00a0dB`,
      remark: `Of right predictions at the largest F1. ${trials}`,
    },
  ];
}

/** Precision against recall in one condition; thinned curves do. */
export function precisionRecall(
  report: AoaReport,
  snrDb: number,
  targets: number,
): { method: string; points: Operating[] }[] {
  const condition = report.conditions.find((one) => one.snrDb === snrDb && one.targets === targets);
  return report.methods.flatMap((method, i) => {
    const points = condition?.methods[i]?.curve;
    return points?.length ? [{ method, points }] : [];
  });
}

export const COUNTERS = ['AIC', 'MDL', 'AIC, forward-backward', 'MDL, forward-backward'];

export function doaFigures(report: DoaReport, range: 'apart' | 'together', regionSnrDb: number): Figure[] {
  const of = (targets: string) =>
    report.conditions.filter((one) => one.targets === targets).sort((a, b) => a.snrDb - b.snrDb);
  const two = of(range);
  const one = of('one');
  const none = of('none');
  const snrs = one.map(({ snrDb }) => snrDb);
  const overSnr = {
    xLabel: 'SNR of a sample (dB)',
    xSteps: [5, 10],
    x: snrs,
    at: (snr: number) => `${fixed(snr, 0)} dB`,
  };
  const where = range === 'apart' ? 'two at ranges of their own' : 'two at one range';
  const trials = `${count(report.trials)} regions a condition.`;
  const share = (values: (number | null | undefined)[], numbers: number[]): Pick<Line, 'values' | 'sigma'> => ({
    values: values.map((value) => (present(value) === null ? null : 100 * (value as number))),
    sigma: values.map((value, i) =>
      present(value) === null ? null : 100 * binomial(value as number, numbers[i] ?? 1),
    ),
  });
  const percent = (value: number): string => `${fixed(value, 1)}\u00a0%`;
  const rules = report.counters ?? COUNTERS;
  const counted = (rule: number, i: number): [number, number] => {
    const conditions = [none[i], one[i], two[i]];
    const right = conditions.map((condition, targets) => condition?.counted[rule]?.[targets] ?? Number.NaN);
    return [sum(right) / 3, sum(conditions.map((condition) => condition?.trials ?? 0))];
  };
  const errors = (value: (of: DoaResult) => number | null | undefined, floor: number): Line[] =>
    report.methods.map((method, i) => ({
      method,
      values: one.map(({ methods }) => present(methods[i] && value(methods[i]))),
      sigma: one.map(({ methods, trials: n }) => {
        const error = present(methods[i] && value(methods[i]));
        return error === null
          ? null
          : Math.max(error / Math.sqrt(2 * Math.max((methods[i]?.found ?? 0) * n, 1)), floor);
      }),
    }));
  const at = two.find(({ snrDb }) => snrDb === regionSnrDb);
  const deviation = (
    name: string,
    title: string,
    values: (i: number) => readonly (number | null)[] | undefined,
    number: number,
  ): Figure => ({
    name,
    title,
    detail: `${where}, ${fixed(regionSnrDb, 0)} dB`,
    xLabel: 'Allowed deviation (°)',
    xSteps: [1, 2],
    x: [0, 2, 4],
    at: (x) => `${x}° allowed`,
    yLabel: 'Regions right (%)',
    y: [0, 103],
    lowerIsBetter: false,
    unit: 'percent',
    show: percent,
    lines: report.methods.map((method, i) => ({ method, ...share([...(values(i) ?? [])], [number, number, number]) })),
    remark: `Both angles, rounded to whole degrees. ${count(number)} regions.`,
  });
  const figures: Figure[] = [
    {
      ...overSnr,
      name: 'counting',
      title: 'Counting targets',
      detail: `none, one, or ${where}`,
      yLabel: 'Counted rightly (%)',
      y: [60, 101],
      lowerIsBetter: false,
      lines: rules.map((method, rule) => {
        const pairs = snrs.map((_, i) => counted(rule, i));
        return {
          method,
          ...share(
            pairs.map(([value]) => value),
            pairs.map(([, n]) => n),
          ),
        };
      }),
      show: percent,
      unit: 'percent',
      remark: `A third each of none, one and two targets. ${trials}`,
    },
    {
      ...overSnr,
      name: 'rmse',
      title: 'One target: error of its angle',
      detail: '',
      yLabel: 'RMSE (°)',
      log: true,
      y: [0.008, 1],
      lowerIsBetter: true,
      lines: errors(({ rmseDeg }) => rmseDeg, 0),
      bounds: [
        { name: 'Cramér–Rao bound', values: report.boundsDeg.map(([frame]) => frame) },
        { name: 'MUSIC in theory', values: report.boundsDeg.map(([, region]) => region) },
      ],
      show: (value) => `${fixed(value, 4)}°`,
      unit: 'rmse_deg',
      remark: `Where as many angles as targets were found. Networks choose among whole degrees, which all targets stand at: their error can be nothing, and is then off the plot. ${trials}`,
    },
    {
      ...overSnr,
      name: 'rounded',
      title: 'One target: error after rounding',
      detail: '',
      yLabel: 'RMSE (°)',
      y: [0, 1],
      lowerIsBetter: true,
      lines: errors(({ roundedRmseDeg }) => roundedRmseDeg, 1 / report.trials),
      show: (value) => `${fixed(value, 4)}°`,
      unit: 'rounded_rmse_deg',
      remark: `The same of angles rounded to whole degrees, so that all methods know as much as the networks. ${trials}`,
    },
    {
      ...overSnr,
      name: 'success',
      title: 'Two targets within 1°',
      detail: where,
      yLabel: 'Regions right (%)',
      y: [0, 103],
      lowerIsBetter: false,
      lines: report.methods.map((method, i) => ({
        method,
        ...share(
          two.map(({ methods }) => methods[i]?.success),
          two.map(({ trials: n }) => n),
        ),
      })),
      show: percent,
      unit: 'percent',
      remark: `Both angles within 1°. ${trials}`,
    },
    deviation('deviation', 'Two targets by allowed deviation', (i) => at?.methods[i]?.within, at?.trials ?? 0),
    deviation('close', 'Close pairs by allowed deviation', (i) => at?.methods[i]?.closeWithin, at?.close ?? 0),
  ];
  return figures.filter(({ lines }) => lines.some(({ values }) => values.some((value) => value !== null)));
}
