/** Monte-Carlo runs of the page's scene: error and share found against one setting, with the bound. */

import { useMemo } from 'preact/hooks';
import type { LegendItem } from '../../../elements/base/drawing.ts';
import { fixed, percentage, significant } from '../../../plots/format.ts';
import { toCsv } from '../../../plots/save.ts';
import { methodStyle, TRUTH_STYLE } from '../../../plots/theme.ts';
import { api } from '../../data.ts';
import { NumberField } from '../../ui/number-field.tsx';
import { PlotFrame } from '../../ui/plot-frame.tsx';
import { ProgressLine } from '../../ui/progress.tsx';
import { Control } from './controls.tsx';
import { angleState, update } from './state.ts';
import {
  cancelSweep,
  limitsOf,
  runSweep,
  type Score,
  type Sweep,
  sweep,
  sweepCancelled,
  sweepIsOld,
  sweepProblem,
  sweepProgress,
  UNITS,
  whyNoSweep,
} from './sweep.ts';

const BOUND = { ...TRUTH_STYLE, dash: [5, 4] };

export function SweepPanel() {
  const state = angleState.value;
  const [from, to] = limitsOf(state);
  const { unit } = UNITS[state.sweep];
  const problem = whyNoSweep(state);
  const made = sweep.value;
  return (
    <section class="stack" aria-labelledby="sweep-title" aria-busy={sweepProgress.value !== null} data-sweep>
      <div class="panel experiment-head">
        <div class="panel-head">
          <h3 id="sweep-title">Monte Carlo</h3>
        </div>
        <p class="remark">
          Draws this scene many times at each of eleven values of one setting, and compares the errors of the chosen
          methods with the bound.
        </p>
        <div class="row choices">
          <Control
            label="Against"
            name="sweep"
            labels={{ snr: 'SNR', separation: 'separation of the first two' }}
            help="The setting that is varied. A separation is about the middle of the first two targets."
            onChange={(swept) => update({ sweep: swept, from: null, to: null })}
          />
          {(['from', 'to'] as const).map((end) => (
            <NumberField
              key={end}
              label={end === 'from' ? 'From' : 'To'}
              name={`sweep-${end}`}
              unit={unit}
              value={end === 'from' ? from : to}
              min={state.sweep === 'snr' ? -30 : state.sweep === 'snapshots' ? 1 : 0.01}
              max={state.sweep === 'snr' ? 60 : state.sweep === 'snapshots' ? 2000 : 120}
              integer={state.sweep === 'snapshots'}
              help={end === 'from' ? 'The first value.' : 'The last value.'}
              onChange={(value) => update({ [end]: value })}
            />
          ))}
          <Control label="Runs" name="runs" help="Scenes drawn at each value." step={50} />
          {sweepProgress.value ? (
            <ProgressLine {...sweepProgress.value} cancel="cancel-sweep" onCancel={cancelSweep} />
          ) : (
            <button
              type="button"
              class="primary"
              data-action="sweep"
              disabled={problem !== null}
              onClick={() => void runSweep(angleState.peek())}
            >
              Run
            </button>
          )}
          {problem && <span class="problem">{problem}</span>}
          {sweepCancelled.value && <span class="muted">Cancelled{made ? '; what was done is shown' : ''}.</span>}
        </div>
      </div>
      {sweepProblem.value && (
        <p class="alert" role="alert" data-error={sweepProblem.value.code}>
          <strong>The runs ended.</strong> {sweepProblem.value.message} <code>{sweepProblem.value.code}</code>
        </p>
      )}
      {sweepIsOld.value && !sweepProgress.value && (
        <p class="notice" data-old-sweep>
          The last runs are of other settings. Run again, or undo the change to see them.
        </p>
      )}
      {made && <Plots key={made.swept} made={made} />}
    </section>
  );
}

function Plots({ made }: { made: Sweep }) {
  const { swept, values, boundDeg, scores, gateDeg, state } = made;
  const { title, unit } = UNITS[swept];
  const log = swept === 'snapshots';
  const x = useMemo(() => (log ? values.map(Math.log10) : values), [made]);
  const infos = api.methods().filter(({ name }) => scores.has(name));
  const extent: [number, number] = [x[0] ?? 0, Math.max(x.at(-1) ?? 1, (x[0] ?? 0) + 1e-3)];
  const column = (of: (score: Score) => number) =>
    infos.map(({ name, title: label }) => ({
      id: name,
      label,
      y: (scores.get(name) ?? []).map((score) => (Number.isFinite(of(score)) ? of(score) : null)),
      style: methodStyle(name),
    }));
  const errors = useMemo(() => {
    const all = column(({ rmseDeg }) => Math.log10(rmseDeg));
    const bound = boundDeg.map((sigma) => (Number.isFinite(sigma) ? Math.log10(sigma) : null));
    const finite = [bound, ...all.map(({ y }) => y)].flat().filter((value): value is number => value !== null);
    const [low, high] = [Math.min(...finite), Math.max(...finite)];
    return {
      x,
      series: [...all, { id: 'bound', label: 'Bound', y: bound, style: BOUND }],
      extent: { x: extent, y: [low - 0.1, Math.max(high, low + 0.1) + 0.1] as const },
    };
  }, [made]);
  const found = useMemo(
    () => ({
      x,
      series: column((score) => 100 * score.found),
      extent: { x: extent, y: [0, 102] as const },
    }),
    [made],
  );
  const legend = (of: (index: number) => Partial<Record<string, string>>): LegendItem[] =>
    infos.map(({ name, title: label }) => ({
      id: name,
      label,
      style: methodStyle(name),
      line: true,
      value: ({ index }) => (index === null ? '–' : (of(index)[name] ?? '–')),
    }));
  const each = (show: (score: Score) => string) => (index: number) =>
    Object.fromEntries([...scores].map(([name, list]) => [name, list[index] ? show(list[index]) : '–']));
  const axis = {
    label: unit ? `${title} (${unit})` : title,
    ...(log ? { log: true } : {}),
  };
  const at = (index: number | null): string => significant(values[index ?? -1] ?? Number.NaN);
  const csv = (): string =>
    toCsv(
      [
        swept === 'snr' ? 'snr_db' : swept === 'separation' ? 'separation_deg' : 'snapshots',
        'crb_deg',
        ...infos.flatMap(({ name }) => [`${name.replaceAll('-', '_')}_rmse_deg`, `${name.replaceAll('-', '_')}_found`]),
      ],
      values.map((value, i) => [
        value,
        boundDeg[i],
        ...infos.flatMap(({ name }) => [scores.get(name)?.[i]?.rmseDeg, scores.get(name)?.[i]?.found]),
      ]),
    );
  const setup = `${state.targets.length} target${state.targets.length === 1 ? '' : 's'}, ${state.runs} runs a value, seed ${state.seed}`;
  const remarks = [`${setup}. Errors of targets found within ${fixed(gateDeg, 1)}°.`];
  return (
    <div class="two">
      <PlotFrame
        title="Error"
        name="sweep-error"
        height="medium"
        content={errors}
        legend={[
          {
            id: 'bound',
            label: 'Cramér–Rao bound',
            style: BOUND,
            line: true,
            value: ({ index }) => `${significant(boundDeg[index ?? -1] ?? Number.NaN)}°`,
          },
          ...legend(each(({ rmseDeg }) => `${significant(rmseDeg)}°`)),
        ]}
        axes={{ x: axis, y: { label: 'RMSE of azimuth (°)', log: true } }}
        readout={({ index }) => `${title} ${at(index)} ${unit}`}
        csv={csv}
        fileParts={[swept]}
        remarks={remarks}
      />
      <PlotFrame
        title="Targets found"
        name="sweep-found"
        height="medium"
        content={found}
        legend={legend(each((score) => percentage(score.found)))}
        axes={{ x: axis, y: { label: 'Share of targets (%)' } }}
        readout={({ index }) => `${title} ${at(index)} ${unit}`}
        csv={csv}
        fileParts={[swept]}
        remarks={remarks}
      />
    </div>
  );
}
