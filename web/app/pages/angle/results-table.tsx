/** Targets against each method's estimates, with errors and bounds. */

import { fixed, milliseconds, signed } from '../../../plots/format.ts';
import { download, fileName, toCsv } from '../../../plots/save.ts';
import { methodStyle } from '../../../plots/theme.ts';
import { api } from '../../data.ts';
import { Swatch } from '../../ui/swatch.tsx';
import { type Answers, isPending } from './compute.ts';
import { assigned } from './score.ts';

export function ResultsTable({ scene, results }: Answers) {
  const { targets } = scene.state;
  const rows = api
    .methods()
    .filter(({ name }) => results.has(name))
    .map((info) => {
      const result = results.get(info.name);
      const pending = result !== undefined && isPending(result);
      const sources = result?.estimate?.sources ?? [];
      return { info, result, pending, sources, assignment: assigned(scene, sources) };
    });
  const sigma = (i: number): number => scene.bound?.[i] ?? Number.NaN;
  const csv = (): string =>
    toCsv(
      [
        'method',
        'target',
        'true_azimuth_deg',
        'true_power_db',
        'azimuth_deg',
        'error_deg',
        'power_db',
        'stated_sigma_deg',
        'crb_sigma_deg',
        'time_ms',
      ],
      rows.flatMap(({ info, result, pending, sources, assignment }) => {
        // Without an estimate nothing is known of a target, not even that it was missed.
        if (pending) return [];
        // Estimates of no target stand below those of targets.
        const pairs = [
          ...targets.map((target, i) => ({ target, i, source: sources[assignment.matched[i] ?? -1] })),
          ...assignment.extra.map((k) => ({ target: undefined, i: undefined, source: sources[k] })),
        ];
        return pairs.map(({ target, i, source }) => [
          info.name,
          i === undefined ? '' : i + 1,
          target?.azimuthDeg,
          target?.powerDb,
          source?.azimuthDeg,
          source && target && source.azimuthDeg - target.azimuthDeg,
          source?.powerDb,
          source?.deviation?.azimuthDeg,
          i === undefined ? undefined : sigma(i),
          result?.milliseconds,
        ]);
      }),
    );
  return (
    <section class="panel" aria-labelledby="results-title" data-table="results">
      <div class="panel-head">
        <h3 id="results-title">Estimates and errors</h3>
        <div class="tools">
          <button
            type="button"
            data-export="csv"
            onClick={() => download(csv(), fileName(['estimates', `seed${scene.state.seed}`], 'csv'))}
          >
            CSV
          </button>
        </div>
      </div>
      {scene.boundProblem && <p class="remark">No bound: {scene.boundProblem.message}</p>}
      <div class="table-scroll" tabIndex={0} role="region" aria-label="Estimates and errors, scrollable">
        <table class="data">
          <thead>
            <tr>
              <th rowSpan={2} scope="col" class="text">
                Method
              </th>
              {targets.map((_, i) => (
                <th key={i} colSpan={3} scope="colgroup" class="group-head">
                  Target {i + 1}
                </th>
              ))}
              <th rowSpan={2} scope="col" title="Estimates that belong to no target">
                Extra
              </th>
              <th rowSpan={2} scope="col" title="Time of one estimate">
                Time
              </th>
            </tr>
            <tr>
              {targets.map((_, i) => [
                <th key={`a${i}`} scope="col" class="group-start">
                  Azimuth ({'°'})
                </th>,
                <th key={`e${i}`} scope="col">
                  Error ({'°'})
                </th>,
                <th key={`p${i}`} scope="col">
                  Power (dB)
                </th>,
              ])}
            </tr>
          </thead>
          <tbody>
            <tr class="reference">
              <th scope="row" class="text">
                Truth
              </th>
              {targets.map((target, i) => [
                <td key={`a${i}`} class="group-start" data-field="truth" data-target={i} data-value={target.azimuthDeg}>
                  {signed(target.azimuthDeg, 2)}
                </td>,
                <td key={`e${i}`} />,
                <td key={`p${i}`}>{signed(target.powerDb, 1)}</td>,
              ])}
              <td />
              <td />
            </tr>
            <tr class="reference">
              <th scope="row" class="text">
                CRB, {scene.boundKind}: {'σ'}
              </th>
              {targets.map((_, i) => [
                <td key={`a${i}`} class="group-start" />,
                <td key={`e${i}`} data-field="crb" data-target={i} data-value={sigma(i)}>
                  {Number.isFinite(sigma(i)) ? `±${fixed(sigma(i), sigma(i) < 0.01 ? 4 : 3)}` : '–'}
                </td>,
                <td key={`p${i}`} />,
              ])}
              <td />
              <td />
            </tr>
            {rows.map(({ info, result, pending, sources, assignment }) => (
              <tr key={info.name} aria-busy={pending} data-row={info.name}>
                <th scope="row" class="text">
                  <Swatch style={methodStyle(info.name)} line={info.spectrum} /> {info.title}
                </th>
                {result?.problem ? (
                  <td class="text problem" colSpan={targets.length * 3 + 2}>
                    {result.problem.message}
                  </td>
                ) : (
                  <>
                    {targets.map((target, i) => {
                      const source = sources[assignment.matched[i] ?? -1];
                      const error = source && source.azimuthDeg - target.azimuthDeg;
                      return [
                        <td
                          key={`a${i}`}
                          class="group-start"
                          data-field="azimuth"
                          data-target={i}
                          data-value={source?.azimuthDeg}
                        >
                          {source ? signed(source.azimuthDeg, 2) : '–'}
                          <Deviation of={source?.deviation?.azimuthDeg} digits={2} field="azimuth-deviation" />
                        </td>,
                        <td key={`e${i}`} data-field="error" data-target={i} data-value={error}>
                          {error !== undefined ? signed(error, 3) : result?.estimate ? 'missed' : '–'}
                        </td>,
                        <td key={`p${i}`}>
                          {source ? signed(source.powerDb, 1) : '–'}
                          <Deviation of={source?.deviation?.powerDb} digits={1} field="power-deviation" />
                        </td>,
                      ];
                    })}
                    <td title={assignment.extra.map((k) => `${signed(sources[k]?.azimuthDeg ?? 0, 1)}°`).join(', ')}>
                      {result?.estimate ? assignment.extra.length : '–'}
                    </td>
                    <td>{pending ? 'running' : milliseconds(result?.milliseconds)}</td>
                  </>
                )}
              </tr>
            ))}
          </tbody>
        </table>
      </div>
      <Warnings rows={rows.map(({ info, result }) => ({ title: info.title, estimate: result?.estimate }))} />
    </section>
  );
}

/** The standard deviation that a network states of a number, where it states one. */
function Deviation({ of, digits, field }: { of: number | undefined; digits: number; field: string }) {
  if (of === undefined) return null;
  const shown = of < 10 ** -digits ? of.toPrecision(1) : fixed(of, digits);
  return (
    <span class="deviation" title="Standard deviation that the network states" data-field={field} data-value={of}>
      {` ±${shown}`}
    </span>
  );
}

function Warnings({
  rows,
}: {
  rows: readonly { title: string; estimate: { resolved: boolean; warnings: { message: string }[] } | undefined }[];
}) {
  const lines = rows.flatMap(({ title, estimate }) => [
    ...(estimate && !estimate.resolved ? [`${title}: sources not resolved`] : []),
    ...(estimate?.warnings ?? []).map(({ message }) => `${title}: ${message}`),
  ]);
  if (!lines.length) return null;
  return (
    <ul class="warnings" aria-label="Warnings">
      {lines.map((line) => (
        <li key={line}>{line}</li>
      ))}
    </ul>
  );
}
