/** What each method makes of the drive, and what it rests on. */
import type { CalibrationResult, Warning } from 'boresight';
import { count, fixed, milliseconds, signed } from '../../../../plots/format.ts';
import { download, fileName, toCsv } from '../../../../plots/save.ts';
import { methodStyle } from '../../../../plots/theme.ts';
import { api } from '../../../data.ts';
import { Swatch } from '../../../ui/swatch.tsx';
import { type Loaded, loaded, sensor } from '../drive/drive.ts';
import { about, WAYS, type Way } from '../motion/ways.ts';
import { fileParts } from '../plots/time-plot.tsx';
import { relativeErrors, SEGMENT_M } from '../plots/trajectory.ts';
import { calibrationOptions, mountingState } from '../state.ts';
import { Outlook } from './outlook.tsx';
import { isPending, type MethodResult, results, where, working } from './process.ts';
import { ReportButton, ReportProblem } from './report-button.tsx';
import { determined } from './verdict.tsx';

interface Row extends MethodResult {
  method: Way;
  title: string;
  result: CalibrationResult | undefined;
}

type Value = number | boolean | null | undefined;

interface Column {
  key: string;
  group: string;
  title: string;
  csv: string;
  help: string;
  value(result: CalibrationResult, row: Row): Value;
  show(value: number): string;
  /** What is true, or stated, in the reference row. */
  reference?(open: Loaded, angleDeg: number): string;
}

/** A standard deviation, which may be infinite (not determined) or zero (not estimated). */
const sigma =
  (digits: number) =>
  (value: number): string =>
    value === Number.POSITIVE_INFINITY ? 'not determined' : value === 0 ? 'fixed' : `±${fixed(value, digits)}`;

const frames = (key: keyof CalibrationResult['frames'], title: string, help: string): Column => ({
  key,
  group: 'Frames',
  title,
  csv: `frames_${key.replace(/[A-Z]/g, (letter) => `_${letter.toLowerCase()}`)}`,
  help,
  value: (r) => r.frames[key],
  show: count,
});

function columns(trueDeg: number | undefined, open: Loaded): Column[] {
  const trajectory = relativeErrors.value;
  const angle: Column[] = [
    {
      key: 'angleDeg',
      group: 'Mounting angle',
      title: 'Angle (°)',
      csv: 'angle_deg',
      help: 'Yaw of boresight in the car’s frame, positive to the left',
      // Where the drive does not tell, the angle is where the search began.
      value: (r) => (determined(r) ? r.angleDeg : null),
      show: (v) => signed(v, 3),
      reference: (_, stated) => signed(stated, 3),
    },
    {
      key: 'sigmaDeg',
      group: 'Mounting angle',
      title: 'σ (°)',
      csv: 'sigma_deg',
      help: 'Its standard deviation, as the method claims it',
      value: (r) => r.sigmaDeg,
      show: sigma(3),
    },
  ];
  if (trueDeg !== undefined) {
    angle.push({
      key: 'error',
      group: 'Mounting angle',
      title: 'Error (°)',
      csv: 'error_deg',
      help: `Less the angle that is ${open.truth ? 'true' : 'stated by the data set'}`,
      // The shorter way round.
      value: (r) => {
        if (!determined(r)) return null;
        const error = r.angleDeg - trueDeg;
        return error - 360 * Math.round(error / 360);
      },
      show: (v) => signed(v, 3),
    });
  }
  return [
    ...angle,
    {
      key: 'converged',
      group: 'Judgement',
      title: 'Settled',
      csv: 'converged',
      help: 'The standard deviation is below the limit, and the angle moves no more',
      value: (r) => r.converged,
      show: String,
    },
    {
      key: 'misaligned',
      group: 'Judgement',
      title: 'Misaligned',
      csv: 'misaligned',
      help: 'The angle differs from the nominal one beyond limit and chance',
      value: (r) => (determined(r) ? r.misaligned : null),
      show: String,
    },
    {
      key: 'scale',
      group: 'Yaw rate',
      title: 'Scale',
      csv: 'scale',
      help: 'Measured over true yaw rate',
      value: (r) => r.scale,
      show: (v) => fixed(v, 4),
      reference: ({ truth }) => (truth ? fixed(truth.yawRate.scale, 4) : '–'),
    },
    {
      key: 'scaleSigma',
      group: 'Yaw rate',
      title: 'σ',
      csv: 'scale_sigma',
      help: 'Standard deviation of the scale; fixed where the method takes it as known',
      value: (r) => r.scaleSigma,
      show: sigma(4),
    },
    {
      key: 'biasDegps',
      group: 'Yaw rate',
      title: 'Bias (°/s)',
      csv: 'bias_degps',
      help: 'Measured at standstill',
      value: (r) => r.biasDegps,
      show: (v) => signed(v, 4),
      reference: ({ truth }) => (truth ? signed(truth.yawRate.biasDegps, 4) : '–'),
    },
    {
      key: 'biasSigmaDegps',
      group: 'Yaw rate',
      title: 'σ (°/s)',
      csv: 'bias_sigma_degps',
      help: 'Standard deviation of the bias',
      value: (r) => r.biasSigmaDegps,
      show: sigma(4),
    },
    {
      key: 'slipGradientDeg',
      group: 'Car',
      title: 'Slip (° s²/m)',
      csv: 'slip_gradient_deg',
      help: 'Slip angle of the rear axle over lateral acceleration; cars have 0.2 to 0.35. Where the drive does not tell, it stays at what cars have',
      value: (r) => (r.slipGradientSigmaDeg > 0 ? r.slipGradientDeg : null),
      show: (v) => fixed(v, 3),
    },
    {
      key: 'slipGradientSigmaDeg',
      group: 'Car',
      title: 'σ (° s²/m)',
      csv: 'slip_gradient_sigma_deg',
      help: 'Standard deviation of the slip',
      value: (r) => (r.slipGradientSigmaDeg > 0 ? r.slipGradientSigmaDeg : null),
      show: (v) => fixed(v, 3),
    },
    {
      key: 'delayS',
      group: 'Car',
      title: 'Delay (ms)',
      csv: 'delay_s',
      help: 'How long before its time stamp a scan was measured',
      value: (r) => (r.delaySigmaS > 0 ? r.delayS : null),
      show: (v) => fixed(1000 * v, 0),
    },
    {
      key: 'speedScale',
      group: 'Car',
      title: 'Speed scale',
      csv: 'speed_scale',
      help: 'The car’s measured speed over the radar’s',
      value: (r) => (r.speedScaleSigma > 0 ? r.speedScale : null),
      show: (v) => fixed(v, 4),
    },
    {
      key: 'rte',
      group: 'Trajectory',
      title: `RTE ${SEGMENT_M} m (m)`,
      csv: 'rte_50m_m',
      help: `Relative trajectory error: mean end-point error of ${SEGMENT_M} m segments of the path that the radar’s motion alone and this angle give`,
      value: (_, { method }) => trajectory.get(method),
      show: (v) => fixed(v, 2),
    },
    {
      key: 'inlierShare',
      group: 'Frames',
      title: 'Inliers (%)',
      csv: 'inlier_share',
      help: 'Static detections over all, of the frames used',
      value: (r) => r.inlierShare,
      show: (v) => fixed(100 * v, 1),
    },
    frames('used', 'Used', 'Frames that went into the angle'),
    frames('standing', 'Standing', 'Left out: the car stood. They tell the bias of the yaw rate'),
    frames('slow', 'Slow', 'Left out: slower than the limit'),
    frames('turning', 'Turning', 'Left out: turning faster than the limit'),
    frames('sparse', 'Sparse', 'Left out: too few detections, or too few of them static'),
    frames('offSpeed', 'Off speed', 'Left out: what most detections agree on is not the car’s own measured speed'),
    frames('withoutMotion', 'No motion', 'Left out: the log has no yaw rate (or speed) at their time'),
    {
      key: 'time',
      group: 'Work',
      title: 'Time',
      csv: 'time_ms',
      help: 'From start to result, on workers that share this machine',
      value: (_, row) => row.milliseconds,
      show: milliseconds,
    },
  ];
}

/** Groups of columns, a table each, so that none is wider than the page. */
const TABLES: readonly { label: string; groups: readonly string[] }[] = [
  { label: 'Mounting angles', groups: ['Mounting angle', 'Judgement', 'Yaw rate', 'Trajectory'] },
  { label: 'The car', groups: ['Car'] },
  { label: 'Frames and work', groups: ['Frames', 'Work'] },
];

const display = (value: Value, show: (value: number) => string): string =>
  value == null || Number.isNaN(value) ? '–' : typeof value === 'boolean' ? (value ? 'yes' : 'no') : show(value);

export function ResultsTable() {
  const open = loaded.value;
  const radar = sensor.value;
  if (!open || !radar) return null;
  const trueDeg = open.statedDeg.get(radar.id);
  const list = columns(trueDeg, open);
  const rows = WAYS.flatMap((method): Row[] => {
    const result = results.value.get(method);
    return result ? [{ ...result, method, title: about(method).title, result: result.calibration?.result }] : [];
  });
  const shared = { rows, open, trueDeg };
  const computed = rows.filter((row) => !isPending(row));
  const csv = (): string =>
    toCsv(
      ['method', ...list.map((column) => column.csv), 'warnings'],
      computed.map((row) => [
        row.method,
        ...list.map(({ value }) => row.result && value(row.result, row)),
        row.result?.warnings.map(({ code }) => code).join(' '),
      ]),
    );
  const warnings = new Map<string, { message: string; titles: string[] }>();
  for (const { title, result } of rows) {
    for (const { code, message } of result?.warnings ?? []) {
      const known = warnings.get(code);
      if (known) known.titles.push(title);
      else warnings.set(code, { message, titles: [title] });
    }
  }
  const save = (content: string, extension: 'csv' | 'json'): void =>
    download(
      new Blob([content], { type: extension === 'csv' ? 'text/csv;charset=utf-8' : 'application/json' }),
      fileName(['mounting', ...fileParts()], extension),
    );
  return (
    <section class="panel" aria-labelledby="angles-title" data-table="results">
      <div class="panel-head">
        <h3 id="angles-title">Mounting angle of radar {radar.id}</h3>
        <div class="tools">
          <ReportButton />
          <button
            type="button"
            data-export="json"
            title="Save results and options"
            onClick={() => save(report(open, radar.id, computed), 'json')}
          >
            JSON
          </button>
          <button type="button" data-export="csv" title="Save the table" onClick={() => save(csv(), 'csv')}>
            CSV
          </button>
        </div>
      </div>
      <ReportProblem />
      <Outlook />
      {TABLES.map(({ label, groups }) => ({ label, part: list.filter(({ group }) => groups.includes(group)) }))
        // No drive tells all of a car, and some nothing.
        .filter(
          ({ part }, i) => i === 0 || !rows.some(isDone) || rows.some((row) => part.some((one) => tells(one, row))),
        )
        .map(({ label, part }) => (
          <Columns key={label} list={part} label={label} {...shared} />
        ))}
      {warnings.size > 0 && (
        <ul class="warnings" aria-label="Warnings">
          {[...warnings].map(([code, { message, titles }]) => (
            <li key={code}>
              {sentence(message)} <code>{code}</code>: {titles.join('; ')}
            </li>
          ))}
        </ul>
      )}
    </section>
  );
}

const isDone = ({ result }: Row): boolean => result !== undefined;
const tells = ({ value }: Column, row: Row): boolean => {
  const is = row.result && value(row.result, row);
  return is != null && !Number.isNaN(is);
};

/** Some of the columns of all rows, as a table. */
function Columns({
  list,
  label,
  rows,
  open,
  trueDeg,
}: {
  list: readonly Column[];
  label: string;
  rows: readonly Row[];
  open: Loaded;
  trueDeg: number | undefined;
}) {
  const starts = new Set(list.filter(({ group }, i) => list[i - 1]?.group !== group).map(({ key }) => key));
  const groups = list
    .filter(({ key }) => starts.has(key))
    .map(({ group }) => ({ group, size: list.filter((column) => column.group === group).length }));
  return (
    <div class="table-scroll" tabIndex={0} role="region" aria-label={`${label}, scrollable`}>
      <table class="data">
        <thead>
          <tr>
            <th rowSpan={2} scope="col" class="text">
              Method
            </th>
            {groups.map(({ group, size }) => (
              <th key={group} colSpan={size} scope="colgroup" class="group-head">
                {group}
              </th>
            ))}
          </tr>
          <tr>
            {list.map(({ key, title, help }) => (
              <th key={key} scope="col" class={starts.has(key) ? 'group-start' : ''} title={help}>
                {title}
              </th>
            ))}
          </tr>
        </thead>
        <tbody>
          {trueDeg !== undefined && list.some(({ reference }) => reference) && (
            <tr class="reference">
              <th scope="row" class="text">
                {open.truth ? 'Truth' : 'Stated by the data set'}
              </th>
              {list.map(({ key, reference }) => (
                <td
                  key={key}
                  class={starts.has(key) ? 'group-start' : ''}
                  data-field={key === 'angleDeg' ? 'truth' : undefined}
                  data-value={key === 'angleDeg' ? trueDeg : undefined}
                >
                  {reference?.(open, trueDeg)}
                </td>
              ))}
            </tr>
          )}
          {rows.map((row) => (
            <tr key={row.method} aria-busy={working.value && isPending(row)} data-row={row.method}>
              <th scope="row" class="text">
                <Swatch style={methodStyle(row.method)} line /> {row.title}
              </th>
              {row.problem ? (
                <td class="text problem" colSpan={list.length}>
                  {row.problem.message} <code>{row.problem.code}</code>
                </td>
              ) : !row.result ? (
                <td class="text muted" colSpan={list.length}>
                  –
                </td>
              ) : (
                list.map(({ key, value, show }) => {
                  const is = value(row.result as CalibrationResult, row);
                  return (
                    <td
                      key={key}
                      data-field={key}
                      data-value={is ?? undefined}
                      class={`${starts.has(key) ? 'group-start' : ''}${key === 'misaligned' && is ? ' bad' : ''}`}
                    >
                      {display(is, show)}
                    </td>
                  );
                })
              )}
            </tr>
          ))}
          {rows.length === 0 && (
            <tr>
              <td class="text muted" colSpan={list.length + 1}>
                No method is chosen, or the radar’s place is not known.
              </td>
            </tr>
          )}
        </tbody>
      </table>
    </div>
  );
}

const sentence = (text: string): string => text.charAt(0).toUpperCase() + text.slice(1);

/** Everything a result rests on; infinite deviations become null. */
function report(open: Loaded, radar: number, rows: readonly Row[]): string {
  const { name, files, drive, source, truth } = open;
  const { scenario, profile, seed, duration, moving, misalignment } = mountingState.value;
  const trajectory = relativeErrors.value;
  const stated = open.statedDeg.get(radar);
  return JSON.stringify(
    {
      boresight: api.version(),
      drive: {
        name,
        format: drive.format,
        files,
        scans: drive.scans.timeS.length,
        detections: drive.detections.azimuthDeg.length,
        counts: drive.counts,
        warnings: drive.warnings satisfies Warning[],
        ...(source === 'simulated'
          ? {
              simulated: {
                scenario,
                profile,
                seed,
                durationS: duration,
                movingPercent: moving,
                misalignmentDeg: misalignment,
              },
            }
          : {}),
      },
      sensor: radar,
      options: where.value && calibrationOptions(mountingState.value, where.value, drive.format),
      ...(stated === undefined ? {} : { [truth ? 'trueDeg' : 'statedDeg']: stated }),
      methods: rows.map(({ method, result, problem }) => ({
        method,
        ...(problem ? { error: problem } : result),
        relativeTrajectoryErrorM: trajectory.get(method) ?? null,
      })),
    },
    null,
    2,
  );
}
