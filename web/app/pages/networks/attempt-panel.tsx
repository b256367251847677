/** The scene that a network was tried on: truth, spectrum, what each method found, and how far off it is. */

import { useEffect, useMemo, useRef } from 'preact/hooks';
import { defineElement } from '../../../elements/base/define.ts';
import { type NamedEstimate, SpectrumElement } from '../../../elements/kinds/spectrum.ts';
import { fixed, milliseconds } from '../../../plots/format.ts';
import { download, fileName, toCsv } from '../../../plots/save.ts';
import { methodStyle } from '../../../plots/theme.ts';
import { type Sight, sightOf } from '../../networks/models.ts';
import { LoadState } from '../../ui/network-note.tsx';
import { ElementFrame } from '../../ui/plot-frame.tsx';
import { Swatch } from '../../ui/swatch.tsx';
import { assign } from '../angle/assign.ts';
import {
  type Attempt,
  attempt,
  attemptProblem,
  COVARIANCE_SNAPSHOTS,
  EFFORT,
  type Row,
  selected,
  trying,
} from './attempt.ts';
import { WARM_UP } from './measure.ts';
import { networksState, update } from './state.ts';

/** Within this of a target an estimate is right, degrees: the papers' limits for snapshots and regions. */
const GATES: Record<Sight, number> = { snapshot: 0.5, covariance: 2, region: 1 };

const SCENES: Record<Sight, string> = {
  snapshot:
    'One simulated snapshot, drawn from the seed: the network beside IAA, NOMP and the plain FFT on the same numbers, none of which knows how many targets there are.',
  covariance: `${COVARIANCE_SNAPSHOTS} simulated snapshots, drawn from the seed: the network beside methods on their covariance. All are told the number of targets.`,
  region:
    'One simulated region of interest, drawn from the seed: the network beside classical methods on the same numbers. All are told the number of targets but those that count it.',
};

const TIME = `median of at least ${EFFORT.fewest} estimates after ${WARM_UP} that are not counted, each with the way to a worker and back`;

defineElement('boresight-spectrum', SpectrumElement);

export function AttemptPanel() {
  const place = useRef<HTMLElement>(null);
  const { run } = networksState.value;
  const wasRun = useRef(run);
  // It may be asked for far from here.
  useEffect(() => {
    if (run && !wasRun.current) place.current?.scrollIntoView({ block: 'nearest' });
    wasRun.current = run;
  }, [run]);
  const model = selected.value;
  const problem = attemptProblem.value;
  if (!model) return null;
  const shown = attempt.value;
  return (
    <section
      ref={place}
      class="stack"
      aria-labelledby="try-title"
      aria-busy={trying.value}
      data-attempt={shown && !trying.value ? shown.scene : undefined}
    >
      <div class="panel experiment-head">
        <h2 id="try-title">Try it: {model.title}</h2>
        <p class="remark">{SCENES[sightOf(model.card)]}</p>
        <p class="row choices">
          {networksState.value.run ? (
            <button type="button" data-action="stop" onClick={() => update({ run: false })}>
              Stop
            </button>
          ) : (
            <button type="button" class="primary" data-action="run" onClick={() => update({ run: true })}>
              Run on this scene
            </button>
          )}
          <LoadState name={model.name} />
        </p>
      </div>
      {problem && (
        <p class="alert" role="alert" data-error={problem.code}>
          <strong>The network could not be run.</strong> {problem.message} <code>{problem.code}</code>
        </p>
      )}
      {shown &&
        (shown.counts.length ? (
          <Counts shown={shown} />
        ) : (
          <>
            <ScenePlot shown={shown} />
            <Found shown={shown} />
          </>
        ))}
    </section>
  );
}

function ScenePlot({ shown }: { shown: Attempt }) {
  const { truth, rows, bound, fieldOfViewDeg } = shown;
  const onRegion = shown.sight === 'region';
  const estimates = useMemo(
    () =>
      rows.map(
        ({ method, title, estimate }, i): NamedEstimate => ({
          estimate: estimate ?? null,
          id: method,
          label: title,
          leading: i === 0,
        }),
      ),
    [shown],
  );
  return (
    <ElementFrame
      key={shown.model}
      tag="boresight-spectrum"
      own={{
        estimates,
        targets: truth,
        boundsDeg: bound ?? null,
        // Levels of regions are relative to the strongest source.
        levels: onRegion ? undefined : 'absolute',
        'floor-db': onRegion ? 30 : 48,
        'high-db': 8,
        sector: fieldOfViewDeg + 3,
        'y-label': onRegion ? 'Level (dB re the strongest)' : 'Level (dB re 0 dB target)',
      }}
      title="Scene"
      detail={shown.scene}
      name="attempt"
      height="tall"
      fileParts={[shown.model]}
    />
  );
}

function Found({ shown }: { shown: Attempt }) {
  const { truth, rows, bound } = shown;
  const gate = GATES[shown.sight];
  const scored = rows.map((row) => {
    const sources = row.estimate?.sources ?? [];
    const { matched, extra } = assign(
      truth.map(({ azimuthDeg }) => azimuthDeg),
      sources,
      gate,
    );
    const errors = matched.flatMap((at, i) =>
      at === undefined ? [] : [(sources[at]?.azimuthDeg ?? 0) - (truth[i]?.azimuthDeg ?? 0)],
    );
    const power = matched.flatMap((at, i) =>
      at === undefined ? [] : [Math.abs((sources[at]?.powerDb ?? 0) - (truth[i]?.powerDb ?? 0))],
    );
    return { row, found: errors.length, extra: extra.length, rmse: rms(errors), power: mean(power) };
  });
  const crb = bound?.length ? rms([...bound]) : Number.NaN;
  const onSnapshot = shown.sight !== 'region';
  const csv = (): string =>
    toCsv(
      ['method', 'found', 'missed', 'false', 'rmse_deg', 'power_error_db', 'median_ms'],
      scored.map(({ row, found, extra, rmse, power }) => [
        row.method,
        found,
        truth.length - found,
        extra,
        rmse,
        onSnapshot ? power : Number.NaN,
        row.milliseconds,
      ]),
    );
  return (
    <section class="panel" aria-labelledby="found-title" data-table="attempt">
      <div class="panel-head">
        <h3 id="found-title">What each found</h3>
        <div class="tools">
          <button
            type="button"
            data-export="csv"
            onClick={() => download(csv(), fileName(['attempt', shown.model], 'csv'))}
          >
            CSV
          </button>
        </div>
      </div>
      <div class="table-scroll" tabIndex={0} role="region" aria-label="What each found, scrollable">
        <table class="data">
          <thead>
            <tr>
              <th scope="col" class="text">
                Method
              </th>
              <th scope="col" title={`Targets with an estimate within ${gate}°`}>
                Found
              </th>
              <th scope="col">Missed</th>
              <th scope="col" title="Estimates that belong to no target">
                False
              </th>
              <th scope="col" title="Root mean square error of those found">
                RMSE (°)
              </th>
              {onSnapshot && (
                <th scope="col" title="Mean absolute error of those found">
                  Power error (dB)
                </th>
              )}
              <th scope="col" title={TIME}>
                Median time
              </th>
            </tr>
          </thead>
          <tbody>
            <tr class="reference">
              <th scope="row" class="text">
                Truth
              </th>
              <td data-field="truth" data-value={truth.length}>
                {truth.length}
              </td>
              <td />
              <td />
              <td>{Number.isFinite(crb) ? `CRB ${fixed(crb, 3)}` : ''}</td>
              {onSnapshot && <td />}
              <td />
            </tr>
            {scored.map(({ row, found, extra, rmse, power }) => (
              <tr key={row.title} data-row={row.method}>
                <th scope="row" class="text">
                  <Swatch style={methodStyle(row.method)} line={Boolean(row.estimate?.spectrum)} /> {row.title}
                </th>
                {row.problem ? (
                  <td class="text problem" colSpan={6}>
                    {row.problem.message}
                  </td>
                ) : (
                  <>
                    <td data-field="found" data-value={found}>
                      {found}
                    </td>
                    <td data-field="missed" data-value={truth.length - found}>
                      {truth.length - found}
                    </td>
                    <td data-field="false" data-value={extra}>
                      {extra}
                    </td>
                    <td data-field="rmse" data-value={rmse}>
                      {fixed(rmse, 3)}
                    </td>
                    {onSnapshot && <td>{fixed(power, 2)}</td>}
                    <td
                      data-field="time"
                      data-value={row.milliseconds}
                      title={row.calls === undefined ? undefined : `${row.calls} calls`}
                    >
                      {row.milliseconds === undefined ? 'running' : milliseconds(row.milliseconds)}
                    </td>
                  </>
                )}
              </tr>
            ))}
          </tbody>
        </table>
      </div>
      <p class="remark">Time: {TIME}.</p>
      <Warnings rows={rows} />
    </section>
  );
}

function Warnings({ rows }: { rows: readonly Row[] }) {
  const lines = rows.flatMap(({ title, estimate }) =>
    (estimate?.warnings ?? []).map(({ message }) => `${title}: ${message}`),
  );
  return lines.length ? (
    <ul class="warnings">
      {lines.map((line) => (
        <li key={line}>{line}</li>
      ))}
    </ul>
  ) : null;
}

function Counts({ shown }: { shown: Attempt }) {
  const most = 2;
  return (
    <section class="panel" aria-labelledby="counts-title" data-table="attempt">
      <div class="panel-head">
        <h3 id="counts-title">How many targets</h3>
        <span class="muted detail">{shown.scene}</span>
      </div>
      <div class="table-scroll" tabIndex={0} role="region" aria-label="How many targets, scrollable">
        <table class="data">
          <thead>
            <tr>
              <th scope="col" class="text">
                Rule
              </th>
              <th scope="col">Targets</th>
              {[0, 1, most].map((number) => (
                <th key={number} scope="col" title="Probability, each for itself">
                  P({number})
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            <tr class="reference">
              <th scope="row" class="text">
                Truth
              </th>
              <td data-field="truth" data-value={shown.truth.length}>
                {shown.truth.length}
              </td>
              <td />
              <td />
              <td />
            </tr>
            {shown.counts.map(({ rule, title, sources, probability }) => (
              <tr key={rule} data-row={rule}>
                <th scope="row" class="text">
                  {title}
                </th>
                <td data-field="sources" data-value={sources} class={sources === shown.truth.length ? '' : 'bad'}>
                  {sources}
                </td>
                {[0, 1, most].map((number) => (
                  <td key={number}>{probability ? fixed(probability[number] ?? Number.NaN, 3) : ''}</td>
                ))}
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </section>
  );
}

const mean = (values: readonly number[]): number =>
  values.length ? values.reduce((a, b) => a + b, 0) / values.length : Number.NaN;
const rms = (values: readonly number[]): number => Math.sqrt(mean(values.map((value) => value * value)));
