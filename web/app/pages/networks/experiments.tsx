/** The papers' experiments as plots, with where the networks lose said in words. */

import { useSignal } from '@preact/signals';
import { useEffect, useMemo } from 'preact/hooks';
import type { LegendItem } from '../../../elements/base/drawing.ts';
import { count, fixed } from '../../../plots/format.ts';
import { type Layer, markers, polyline } from '../../../plots/layers.ts';
import { toCsv } from '../../../plots/save.ts';
import { TRUTH_STYLE } from '../../../plots/theme.ts';
import { SelectField } from '../../ui/field.tsx';
import { PlotFrame } from '../../ui/plot-frame.tsx';
import { Swatch } from '../../ui/swatch.tsx';
import { aoaFigures, doaFigures, type Figure, precisionRecall } from './figures.ts';
import { styleOf, titleOf } from './methods.ts';
import { type AoaReport, type DoaReport, loadResults, results, resultsProblem } from './results.ts';
import { EXPERIMENT_SNRS, networksState, REGION_SNRS, TARGETS, update } from './state.ts';
import { hardest, LEVEL_SIGMAS, verdicts } from './verdict.ts';

export function Experiments() {
  useEffect(() => void loadResults(), []);
  const problem = resultsProblem.value;
  if (problem)
    return (
      <p class="alert" role="alert" data-error={problem.code}>
        <strong>The experiments’ results are not there.</strong> {problem.message}
      </p>
    );
  const found = results.value;
  if (!found)
    return (
      <p class="panel loading" role="status">
        Loading the experiments’ results
      </p>
    );
  if (!found.aoa && !found.doa) return <p class="notice">This copy of the page has no results of experiments.</p>;
  return (
    <>
      {found.aoa && <Snapshots report={found.aoa} />}
      {found.doa && <Regions report={found.doa} />}
    </>
  );
}

/** What is not shown at first: the plots would be full. */
const HIDDEN = [
  'capon',
  'bartlett',
  'iaa',
  'min-norm',
  'min-norm, smoothed',
  'esprit',
  'music, smoothed',
  'root-music',
  'esprit, smoothed',
  'nomp',
  'sparse-bayesian',
  'AIC',
  'AIC, forward-backward',
];

function useChosen(methods: readonly string[], all: boolean) {
  const first = all
    ? ['capon', 'nomp, refined', 'nomp+refined', ...methods.filter((method) => method.includes('-displaced'))]
    : HIDDEN;
  const hidden = useSignal<ReadonlySet<string>>(new Set(first));
  const chosen = (method: string): boolean => !hidden.value.has(method);
  const list = (
    <details class="panel method-choice">
      <summary>
        Methods on these plots: {methods.filter(chosen).length} of {methods.length}
      </summary>
      <fieldset class="methods columns" aria-label="Methods on these plots">
        {methods.map((method) => (
          <label key={method} class="method">
            <input
              type="checkbox"
              name={`show-${method}`}
              checked={chosen(method)}
              onChange={({ currentTarget }) => {
                const next = new Set(hidden.value);
                if (currentTarget.checked) next.delete(method);
                else next.add(method);
                hidden.value = next;
              }}
            />
            <Swatch style={styleOf(method)} line />
            <span>{titleOf(method)}</span>
          </label>
        ))}
      </fieldset>
    </details>
  );
  return { chosen, list };
}

function Snapshots({ report }: { report: AoaReport }) {
  const { at, of } = networksState.value;
  const { chosen, list } = useChosen(report.methods, true);
  const figures = useMemo(() => aoaFigures(report, Number(at)), [report, at]);
  return (
    <section class="stack" aria-labelledby="aoa-title" data-experiment="aoa">
      <div class="panel experiment-head">
        <h2 id="aoa-title">Many targets in one snapshot</h2>
        <p class="remark">
          Networks against the classical methods on {report.array}: 2 to 10 targets within 60° of boresight, powers
          within 13 dB, {count(report.trials)} snapshots a condition, seed {report.seed}. After Figures 4 and 5 of the
          AAETR paper, whose array is not published.
        </p>
        <div class="row choices">
          <SelectField
            label="SNR"
            name="at"
            value={at}
            options={EXPERIMENT_SNRS.map((snr) => [snr, `${snr} dB`] as const)}
            help="Power of a 0 dB target at one element over the noise power there. The weakest targets have 13 dB less."
            onChange={(value) => update({ at: value })}
          />
          <SelectField
            label="Precision and recall of"
            name="of"
            value={of}
            options={TARGETS.map((number) => [number, `${number} targets`] as const)}
            help="Number of targets in the snapshots of the first plot."
            onChange={(value) => update({ of: value })}
          />
        </div>
      </div>
      <Losses figures={figures} of="aoa" />
      {list}
      <div class="two">
        <PrecisionRecall report={report} chosen={chosen} />
        {figures.map((figure) => (
          <FigurePlot key={figure.name} figure={figure} chosen={chosen} />
        ))}
      </div>
    </section>
  );
}

function Regions({ report }: { report: DoaReport }) {
  const { regionAt, range } = networksState.value;
  const { chosen, list } = useChosen(report.methods, false);
  const figures = useMemo(() => doaFigures(report, range, Number(regionAt)), [report, regionAt, range]);
  return (
    <section class="stack" aria-labelledby="doa-title" data-experiment="doa">
      <div class="panel experiment-head">
        <h2 id="doa-title">Up to two targets in a region of a data cube</h2>
        <p class="remark">
          The counting network, the 3D-CNN and the DNNs against the classical methods: 8 elements, 4 chirps, 65 range
          bins, targets at whole degrees from −10 to 10, {count(report.trials)} regions a condition, seed {report.seed}.
          After Figures 6 to 9 of the 3D-CNN paper, whose last is of field measurements. All that estimate angles are
          told the number of targets. The networks know besides that targets stand at whole degrees within 10 of
          boresight, as they do here; the classical methods know that they are within 15.
        </p>
        <div class="row choices">
          <SelectField
            label="Two targets"
            name="range"
            value={range}
            options={[
              ['apart', 'at ranges of their own'],
              ['together', 'at one range'],
            ]}
            help="At one range their echoes are coherent: the same but for a constant factor in every bin and chirp."
            onChange={(value) => update({ range: value })}
          />
          <SelectField
            label="Deviations at"
            name="regionAt"
            value={regionAt}
            options={REGION_SNRS.map((snr) => [snr, `${snr.replace('-', '−')} dB`] as const)}
            help="SNR of the last two plots: of one sample of one chirp at one element, before any transform."
            onChange={(value) => update({ regionAt: value })}
          />
        </div>
      </div>
      <Losses figures={figures} of="doa" />
      {list}
      <div class="two">
        {figures.map((figure) => (
          <FigurePlot key={figure.name} figure={figure} chosen={chosen} />
        ))}
      </div>
    </section>
  );
}

/** What the figures say of the networks, counted from them. */
function Losses({ figures, of }: { figures: readonly Figure[]; of: 'aoa' | 'doa' }) {
  const rows = figures.flatMap((figure) => verdicts(figure).networks.map((network) => ({ figure, network })));
  if (!rows.length)
    return (
      <p class="notice" data-verdict="none">
        No network is in these results: they are of the classical methods alone.
      </p>
    );
  return (
    <details class="panel method-choice" data-verdict="counted">
      <summary id={`${of}-losses`}>Each network against the classical methods, figure by figure, in words</summary>
      <ul class="outcomes">
        {rows.map(({ figure, network }) => {
          const loss = hardest(figure, network);
          return (
            <li
              key={figure.name + network.method}
              data-figure={figure.name}
              data-network={network.method}
              data-loses={loss ? loss.against : undefined}
            >
              <Swatch style={styleOf(network.method)} line />
              <p>
                <b>{titleOf(network.method)}</b> ({figure.title}): {outcome(figure, network.method, loss)}
              </p>
            </li>
          );
        })}
      </ul>
      <p class="remark">
        Values are level when they differ by less than {LEVEL_SIGMAS} standard deviations of what so many trials leave
        uncertain. All classical methods are compared, shown or not.
      </p>
    </details>
  );
}

function outcome(figure: Figure, method: string, loss: ReturnType<typeof hardest>): string {
  const { classical, of } = verdicts(figure);
  const network = figure.lines.find((line) => line.method === method);
  if (!network) return '';
  const all = classical.map((other) => of(network, other));
  const beaten = all.filter(({ behind, ahead }) => behind === 0 && ahead > 0).map(({ against }) => titleOf(against));
  const others =
    beaten.length === all.length ? 'all of them' : beaten.length > 4 ? `${beaten.length} others` : beaten.join('; ');
  const better = beaten.length ? ` Never behind, and somewhere ahead of ${others}.` : '';
  if (!loss?.worst) return `No classical method beats it.${better}`;
  const { ahead, level, behind, worst } = loss;
  return (
    `Loses to ${titleOf(loss.against)} in ${behind} of ${ahead + level + behind} conditions` +
    `${level ? `, level in ${level}` : ''}${ahead ? `, ahead in ${ahead}` : ''}; worst ${figure.at(worst.x)}: ${figure.show(worst.value)} against ${figure.show(worst.other)}.${better}`
  );
}

function FigurePlot({ figure, chosen }: { figure: Figure; chosen(method: string): boolean }) {
  const lines = figure.lines.filter(({ method, values }) => chosen(method) && values.some((value) => value !== null));
  const key = lines.map(({ method }) => method).join();
  const content = useMemo(() => {
    const scale = (value: number | null): number | null =>
      value === null ? null : figure.log ? Math.log10(Math.max(value, figure.y[0] / 10)) : value;
    const series = lines.map(({ method, values }) => ({
      id: method,
      label: titleOf(method),
      y: values.map(scale),
      style: styleOf(method),
    }));
    const bounds = (figure.bounds ?? []).map(({ name, values }, i) => ({
      id: name,
      label: name,
      y: values.map(scale),
      style: boundStyle(i),
    }));
    const [left = 0, right = 1] = [figure.x[0], figure.x.at(-1)];
    const margin = (right - left) * 0.04;
    return {
      x: figure.x,
      series: [...bounds, ...series],
      extent: {
        x: [left - margin, right + margin] as const,
        y: extentOf(
          [...bounds, ...series].flatMap(({ y }) => y),
          figure,
        ),
      },
      above: [
        markers(
          series.flatMap(({ y, style }) =>
            figure.x.flatMap((x, i) => (y[i] == null ? [] : [{ x, y: y[i] as number, style, size: 3.8 }])),
          ),
        ),
      ],
    };
  }, [figure, key]);
  const legend: LegendItem[] = [
    ...lines.map(
      ({ method, values }): LegendItem => ({
        id: method,
        label: titleOf(method),
        style: styleOf(method),
        line: true,
        value: ({ index }) => (values[index ?? -1] == null ? '–' : figure.show(values[index ?? -1] as number)),
      }),
    ),
    ...(figure.bounds ?? []).map(
      ({ name, values }, i): LegendItem => ({
        id: name,
        label: name,
        style: boundStyle(i),
        line: true,
        value: ({ index }) => (values[index ?? -1] == null ? '–' : figure.show(values[index ?? -1] as number)),
      }),
    ),
  ];
  return (
    <PlotFrame
      title={figure.title}
      detail={figure.detail}
      name={`figure-${figure.name}`}
      height="medium"
      content={content}
      legend={legend}
      axes={{
        x: { label: figure.xLabel, steps: figure.xSteps },
        y: { label: figure.yLabel, ...(figure.log ? { log: true, width: 58 } : {}) },
      }}
      readout={({ index }) => (index === null ? '' : figure.at(figure.x[index] as number))}
      csv={() =>
        toCsv(
          ['method', figure.xLabel, figure.unit],
          [...figure.lines, ...(figure.bounds ?? []).map(({ name, values }) => ({ method: name, values }))].flatMap(
            ({ method, values }) => figure.x.map((x, i) => [method, x, values[i]]),
          ),
        )
      }
      fileParts={[figure.detail]}
      remarks={[figure.remark]}
    />
  );
}

/** All that is shown, within what a figure may show. */
function extentOf(values: readonly (number | null)[], { y: [low, high], log }: Figure): readonly [number, number] {
  const [least, most] = log ? [Math.log10(low), Math.log10(high)] : [low, high];
  const there = values.filter((value) => value !== null);
  const [from, to] = [Math.max(Math.min(...there), least), Math.min(Math.max(...there), most)];
  const margin = Math.max((to - from) * 0.06, (most - least) * 0.01);
  return from <= to ? [Math.max(from - margin, least), Math.min(to + margin, most)] : [least, most];
}

const boundStyle = (i: number) => ({ color: TRUTH_STYLE.color, width: 1.2, dash: i ? [2, 3] : [10, 4] });

function PrecisionRecall({ report, chosen }: { report: AoaReport; chosen(method: string): boolean }) {
  const { at, of } = networksState.value;
  const curves = useMemo(() => precisionRecall(report, Number(at), Number(of)), [report, at, of]);
  const shown = curves.filter(({ method }) => chosen(method));
  const key = shown.map(({ method }) => method).join();
  const content = useMemo(() => {
    const above: Layer[] = shown.map(({ method, points }) =>
      polyline(
        points.map(({ recall }) => recall),
        points.map(({ precision }) => precision),
        styleOf(method),
      ),
    );
    const best = shown.map(({ method, points }) => {
      const point = points.reduce((a, b) => (b.f1 > a.f1 ? b : a));
      return { x: point.recall, y: point.precision, style: styleOf(method) };
    });
    return {
      x: [],
      series: [],
      extent: { x: [0.8, 1.003] as const, y: [0.8, 1.005] as const },
      above: [...above, markers(best)],
    };
  }, [curves, key]);
  if (!curves.length) return null;
  return (
    <PlotFrame
      title="Precision against recall"
      detail={`${report.array}, ${of} targets, ${at} dB`}
      name="figure-precision-recall"
      height="medium"
      content={content}
      legend={shown.map(({ method }) => ({ id: method, label: titleOf(method), style: styleOf(method), line: true }))}
      axes={{ x: { label: 'Recall' }, y: { label: 'Precision' } }}
      readout={({ x, y }) => `Recall ${fixed(x, 3)}   Precision ${fixed(y, 3)}`}
      csv={() =>
        toCsv(
          ['method', 'recall', 'precision'],
          curves.flatMap(({ method, points }) => points.map(({ recall, precision }) => [method, recall, precision])),
        )
      }
      fileParts={[`${of}-targets`, `${at}db`]}
      remarks={[
        'Each curve runs through thresholds; its sign stands at the largest F1. Methods that leave the plot are worse than 0.8 there.',
      ]}
    />
  );
}
