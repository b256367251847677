/** A calibration with its uncertainty, how it does on other data, and the chosen cell before and after. */
import type { ArrayCalibration, CheckFigures, Estimate } from 'boresight';
import { useMemo } from 'preact/hooks';
import type { NamedEstimate } from '../../../elements/spectrum.ts';
import { count, fixed, signed } from '../../../plots/format.ts';
import { horizontalLine, type Marker, markers } from '../../../plots/layers.ts';
import { toCsv } from '../../../plots/save.ts';
import { closes } from '../../../plots/spectra.ts';
import { ACCENT_STYLE, methodStyle, type SeriesStyle } from '../../../plots/theme.ts';
import { ElementFrame, PlotFrame } from '../../ui/plot-frame.tsx';
import {
  type BeforeAfter,
  beforeAfter,
  beforeAfterProblem,
  beforeAfterWorking,
  type FrameSet,
} from './before-after.ts';
import type { Made } from './calibrate.ts';
import { usedArray } from './process.ts';

type FileParts = readonly (string | number)[];

const METHODS: Readonly<Record<ArrayCalibration['method'], string>> = {
  given: 'given by hand',
  reflector: 'known angles',
  'self-calibration': 'unknown angles',
  'steering-table': 'measured steering',
  'board-configuration': 'configuration',
};

const UNKNOWN: Readonly<Record<ArrayCalibration['notIdentifiable'][number], string>> = {
  'common-gain': 'a gain common to all channels, which counts as power of the targets',
  'common-phase': 'a phase common to all channels, which counts as phase of the targets',
  direction:
    'a phase that rises evenly over the array: all directions may be turned alike, which only a reflector at a known angle tells',
  displacement: 'where each element is',
  coupling: 'coupling between channels',
  'range-bias': 'what ranges are too long by, which only reflectors at exact ranges tell',
};

const STATES = {
  used: 'used',
  weak: 'left out: weak',
  'several-targets': 'left out: several targets',
  'does-not-fit': 'left out: no plane wave',
} as const;

const FRAMES: Readonly<Record<FrameSet, string>> = {
  used: 'frames it was made from',
  others: 'frames not used for it',
  all: 'all frames',
};

/** With its standard deviation where that is known. */
const withDeviation = (value: string, deviation: number | undefined, digits: number): string =>
  deviation === undefined ? value : `${value} ± ${fixed(deviation, digits)}`;

export function CalibrationResults({
  calibration,
  made,
  fileParts,
}: {
  calibration: ArrayCalibration;
  /** Where it was made here. */
  made: Made | null;
  fileParts: FileParts;
}) {
  const facts: [string, string, string, number | undefined][] = [
    ['Made from', METHODS[calibration.method], 'How it was found', undefined],
    ['Cells used', count(calibration.cells), 'Cells it was made from', calibration.cells],
    [
      'Cells left out',
      count(calibration.cellsLeftOut),
      'Cells that do not hold one plane wave',
      calibration.cellsLeftOut,
    ],
    ['Frames', count(calibration.frames), 'Frames it was made from', calibration.frames],
    [
      'Left of a target',
      calibration.residualDb === undefined ? 'not known' : `${fixed(calibration.residualDb, 1)} dB`,
      'Power that is left of a single target once it is fitted, over its own',
      calibration.residualDb,
    ],
    [
      'Phase left',
      calibration.residualPhaseDeg === undefined ? 'not known' : `${fixed(calibration.residualPhaseDeg, 1)}° rms`,
      'In each channel and cell',
      calibration.residualPhaseDeg,
    ],
    [
      'Gain left',
      calibration.residualGainDb === undefined ? 'not known' : `${fixed(calibration.residualGainDb, 2)} dB rms`,
      'In each channel and cell',
      calibration.residualGainDb,
    ],
    [
      'Range bias',
      calibration.notIdentifiable.includes('range-bias')
        ? 'not told'
        : `${withDeviation(fixed(calibration.rangeBiasM, 3), calibration.rangeBiasStdM, 3)} m`,
      'What measured ranges are too long by',
      calibration.rangeBiasM,
    ],
  ];
  return (
    <>
      <dl class="facts flat" data-facts="array-calibration">
        {facts.map(([term, text, help, value]) => (
          <div key={term} title={help} data-value={value}>
            <dt>{term}</dt>
            <dd>{text}</dd>
          </div>
        ))}
      </dl>
      {calibration.notIdentifiable.length > 0 && (
        <p class="remark" data-not-identifiable={calibration.notIdentifiable.join(',')}>
          Not told by these data: {calibration.notIdentifiable.map((one) => UNKNOWN[one]).join('; ')}.
        </p>
      )}
      <Channels calibration={calibration} fileParts={fileParts} />
      {made && <Check {...made} />}
      <CellBeforeAfter fileParts={fileParts} />
    </>
  );
}

function Channels({ calibration, fileParts }: { calibration: ArrayCalibration; fileParts: FileParts }) {
  const { channels, rx } = calibration;
  const moved = channels.some(({ displacement }) => displacement);
  return (
    <>
      <div class="two">
        <ChannelPlot
          calibration={calibration}
          quantity="gain"
          title="Gain of each channel"
          unit="dB"
          of={({ gainDb, gainStdDb }) => [gainDb, gainStdDb]}
          fileParts={fileParts}
        />
        <ChannelPlot
          calibration={calibration}
          quantity="phase"
          title="Phase of each channel"
          unit="°"
          of={({ phaseDeg, phaseStdDeg }) => [phaseDeg, phaseStdDeg]}
          fileParts={fileParts}
        />
      </div>
      <div class="table-scroll capped" tabIndex={0} role="region" aria-label="Channels of the array, scrollable">
        <table class="data compact" data-table="channels">
          <thead>
            <tr>
              <th scope="col" class="text">
                Channel
              </th>
              <th scope="col" title="In their order of transmission">
                Transmitter
              </th>
              <th scope="col">Receiver</th>
              <th scope="col" title="Over that of the plan, with its standard deviation">
                Gain (dB)
              </th>
              <th scope="col" title="Over that of the plan, with its standard deviation">
                Phase (°)
              </th>
              {moved && (
                <th scope="col" title="To the left, and upwards">
                  Displacement (λ/2)
                </th>
              )}
            </tr>
          </thead>
          <tbody>
            {channels.map(({ gainDb, gainStdDb, phaseDeg, phaseStdDeg, displacement }, i) => (
              <tr key={i} data-channel={i}>
                <th scope="row" class="text">
                  {i + 1}
                </th>
                <td>{Math.floor(i / rx.length) + 1}</td>
                <td>{(i % rx.length) + 1}</td>
                <td data-field="gainDb" data-value={gainDb} data-deviation={gainStdDb}>
                  {withDeviation(signed(gainDb, 2), gainStdDb, 2)}
                </td>
                <td data-field="phaseDeg" data-value={phaseDeg} data-deviation={phaseStdDeg}>
                  {withDeviation(signed(phaseDeg, 1), phaseStdDeg, 1)}
                </td>
                {moved && (
                  <td>
                    {(displacement ?? [0, 0, 0])
                      .slice(1)
                      .map((one) => signed(one, 3))
                      .join(', ')}
                  </td>
                )}
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </>
  );
}

const POINTS: SeriesStyle = { color: ACCENT_STYLE.color, marker: 'circle' };

function ChannelPlot({
  calibration,
  quantity,
  title,
  unit,
  of,
  fileParts,
}: {
  calibration: ArrayCalibration;
  quantity: 'gain' | 'phase';
  title: string;
  unit: string;
  of(channel: ArrayCalibration['channels'][number]): readonly [value: number, deviation: number | undefined];
  fileParts: FileParts;
}) {
  const points = useMemo(() => calibration.channels.map(of), [calibration]);
  const label = `${quantity === 'gain' ? 'Gain' : 'Phase'} (${unit})`;
  const known = points.some(([, deviation]) => deviation !== undefined);
  const content = useMemo(() => {
    const reach = Math.max(...points.map(([value, deviation = 0]) => Math.abs(value) + deviation), 1e-3) * 1.15;
    return {
      x: points.map((_, i) => i + 1),
      series: [],
      above: [
        horizontalLine(0, 'plan'),
        markers(
          points.map(
            ([y, deviation], i): Marker => ({
              x: i + 1,
              y,
              style: POINTS,
              ...(deviation === undefined ? {} : { deviation: { x: 0, y: deviation } }),
            }),
          ),
        ),
      ],
      // The name of the line stands behind the last.
      extent: { x: [0.5, points.length + 1.1] as const, y: [-reach, reach] as const },
    };
  }, [points]);
  const text = ([value, deviation]: readonly [number, number | undefined]): string =>
    withDeviation(signed(value, 2), deviation, 2);
  return (
    <PlotFrame
      title={title}
      name={`channel-${quantity}`}
      height="short"
      content={content}
      axes={{ x: { label: 'Virtual channel', steps: [1, 2, 5, 10, 20, 50, 100] }, y: { label } }}
      legend={[{ id: quantity, label: known ? `${label}, bars ±σ` : label, style: POINTS, line: false }]}
      alternative={points.map((point, i) => `Channel ${i + 1}: ${text(point)} ${unit}.`).join('\n')}
      readout={({ x, y, index }) => {
        const point = points[index ?? -1];
        return point
          ? `Channel ${(index ?? 0) + 1}   ${text(point)} ${unit}`
          : `Channel ${fixed(x, 0)}   ${fixed(y, 2)} ${unit}`;
      }}
      csv={() => {
        const name = quantity === 'gain' ? 'gain_db' : 'phase_deg';
        return toCsv(
          ['channel', name, `${name}_std`],
          points.map(([value, deviation], i) => [i + 1, value, deviation]),
        );
      }}
      fileParts={fileParts}
      remarks={['Over that of the plan, all receivers of a transmitter after each other.']}
    />
  );
}

/** What the calibration does on cells that it was not made from. */
function Check({ result, frames }: Made) {
  const { check, leftOut, cells, warnings } = result;
  const columns: { id: string; title: string; of: CheckFigures; help: string }[] = [
    ...(check
      ? [
          { id: 'before', title: 'As planned', of: check.before, help: 'On frames not used for it' },
          { id: 'after', title: 'Calibrated', of: check.after, help: 'On frames not used for it' },
        ]
      : []),
    ...(leftOut
      ? [
          {
            id: 'left-out',
            title: 'By the other cells',
            of: leftOut,
            help: 'Each cell under a calibration from all others: what it does to targets that it has not seen',
          },
        ]
      : []),
  ];
  const rows: { id: keyof CheckFigures; title: string; digits: number }[] = [
    { id: 'residualPhaseDeg', title: 'Phase left (° rms)', digits: 1 },
    { id: 'residualGainDb', title: 'Gain left (dB rms)', digits: 2 },
    { id: 'residualDb', title: 'Left of a target (dB)', digits: 1 },
    { id: 'sidelobeDb', title: 'Highest sidelobe (dB)', digits: 1 },
  ];
  return (
    <>
      {columns.length > 0 ? (
        <div class="table-scroll" tabIndex={0} role="region" aria-label="Check of the calibration, scrollable">
          <table class="data compact" data-table="calibration-check">
            <caption class="remark">
              Check on{' '}
              {check
                ? `${count(check.cells.length)} cells of ${count(check.frames)} frames not used for it`
                : 'cells left out in turn'}
            </caption>
            <thead>
              <tr>
                <th scope="col" class="text">
                  Over all cells
                </th>
                {columns.map(({ id, title, help }) => (
                  <th key={id} scope="col" title={help}>
                    {title}
                  </th>
                ))}
              </tr>
            </thead>
            <tbody>
              {rows.map(({ id: row, title, digits }) => (
                <tr key={row} data-row={row}>
                  <th scope="row" class="text">
                    {title}
                  </th>
                  {columns.map(({ id, of }) => (
                    <td key={id} data-field={id} data-value={of[row]}>
                      {fixed(of[row], digits)}
                    </td>
                  ))}
                </tr>
              ))}
            </tbody>
          </table>
        </div>
      ) : (
        <p class="remark">
          {frames.others.length
            ? 'Not checked: none of its targets is in its cell in the other frames.'
            : 'Not checked: all frames went into it.'}
        </p>
      )}
      <details class="group" data-cells>
        <summary>Cells it was made from, and those left out</summary>
        <div class="table-scroll capped" tabIndex={0} role="region" aria-label="Cells of the calibration, scrollable">
          <table class="data compact">
            <thead>
              <tr>
                <th scope="col">Range (m)</th>
                <th scope="col">Rate (m/s)</th>
                <th scope="col" title="In all frames together, over the noise of one">
                  SNR (dB)
                </th>
                <th scope="col" title="As given, or as found with the calibration">
                  Azimuth (°)
                </th>
                <th scope="col" title="Power left once one plane wave is fitted, over that of the cell">
                  Left over (dB)
                </th>
                <th scope="col" class="text">
                  State
                </th>
              </tr>
            </thead>
            <tbody>
              {cells.map((one) => (
                <tr key={`${one.rangeBin}:${one.dopplerBin}`} data-state={one.state}>
                  <td>{fixed(one.rangeM, 2)}</td>
                  <td>{signed(one.rateMps, 2)}</td>
                  <td>{fixed(one.snrDb, 1)}</td>
                  <td>{signed(one.azimuthDeg, 1)}</td>
                  <td>{fixed(one.residualDb, 1)}</td>
                  <td class="text">{STATES[one.state]}</td>
                </tr>
              ))}
            </tbody>
          </table>
        </div>
      </details>
      {warnings.length > 0 && (
        <ul class="warnings">
          {warnings.map(({ code, message }) => (
            <li key={code}>
              {message} <code>{code}</code>
            </li>
          ))}
        </ul>
      )}
    </>
  );
}

function CellBeforeAfter({ fileParts }: { fileParts: FileParts }) {
  const both = beforeAfter.value;
  const problem = beforeAfterProblem.value;
  if (problem)
    return (
      <p class="alert" role="alert" data-error={problem.code}>
        {problem.message} <code>{problem.code}</code>
      </p>
    );
  if (!both) return <p class="remark">Looking at the chosen cell</p>;
  return (
    <div aria-busy={beforeAfterWorking.value} data-before-after>
      <div class="two">
        {both.sets.map((set) => (
          <Spectra key={set.frames} set={set} cell={both.cell} fileParts={fileParts} />
        ))}
      </div>
      <div class="table-scroll" tabIndex={0} role="region" aria-label="The chosen cell before and after, scrollable">
        <table class="data compact" data-table="before-after">
          <caption class="remark">
            The chosen cell ({both.cell.rangeBin}, {both.cell.dopplerBin}) as planned and calibrated
          </caption>
          <thead>
            <tr>
              <th scope="col" class="text">
                Frames
              </th>
              <th scope="col" class="text">
                Array
              </th>
              <th scope="col" title="Of the conventional beam, over its peak">
                Peak sidelobe (dB)
              </th>
              <th
                scope="col"
                title="Newtonized orthogonal matching pursuit; calibrated, what the calibration leaves of a target counts as array error, or what is chosen as such"
              >
                Targets by NOMP
              </th>
              <th scope="col" title="Strongest first">
                At (°)
              </th>
              <th
                scope="col"
                title="Minimum description length; calibrated, what the calibration leaves of a target counts as array error, or what is chosen as such"
              >
                Targets by MDL
              </th>
            </tr>
          </thead>
          <tbody>
            {both.sets.flatMap((set) =>
              (['before', 'after'] as const).map((when) => {
                const { sidelobeDb, targetsDeg, count: counted } = set[when];
                return (
                  <tr key={`${set.frames}-${when}`} data-row={`${set.frames}-${when}`}>
                    <th scope="row" class="text">
                      {FRAMES[set.frames]} ({set.count})
                    </th>
                    <td class="text">{when === 'before' ? 'as planned' : 'calibrated'}</td>
                    <td data-field="sidelobe" data-value={sidelobeDb ?? undefined}>
                      {sidelobeDb === null ? '–' : fixed(sidelobeDb, 1)}
                    </td>
                    <td data-field="nomp" data-value={targetsDeg.length}>
                      {targetsDeg.length}
                    </td>
                    <td data-field="azimuths" data-value={targetsDeg.join(',')}>
                      {targetsDeg
                        .slice(0, 4)
                        .map((one) => signed(one, 1))
                        .join(', ') || '–'}
                      {targetsDeg.length > 4 ? ' …' : ''}
                    </td>
                    <td data-field="mdl" data-value={counted}>
                      {counted}
                    </td>
                  </tr>
                );
              }),
            )}
          </tbody>
        </table>
      </div>
    </div>
  );
}

/** Of a beam every sidelobe is a source. */
const peakAlone = (beam: Estimate): Estimate => ({ ...beam, sources: beam.sources.slice(0, 1) });

function Spectra({
  set,
  cell,
  fileParts,
}: {
  set: BeforeAfter['sets'][number];
  cell: BeforeAfter['cell'];
  fileParts: FileParts;
}) {
  const { positions, unambiguousDeg = 90 } = usedArray.value ?? {};
  const estimates = useMemo(
    (): NamedEstimate[] => [
      {
        id: 'planned',
        label: 'As planned',
        estimate: peakAlone(set.before.beam),
        style: { ...methodStyle('bartlett'), dash: [5, 3] },
      },
      { id: 'calibrated', label: 'Calibrated', estimate: peakAlone(set.after.beam), style: ACCENT_STYLE, line: true },
    ],
    [set],
  );
  return (
    <ElementFrame
      tag="boresight-spectrum"
      own={{
        estimates,
        'floor-db': 40,
        sector: 90,
        'unambiguous-deg': unambiguousDeg,
        closed: positions !== undefined && closes(positions),
      }}
      title="Beam before and after"
      detail={`${FRAMES[set.frames]} (${set.count})`}
      name={`before-after-${set.frames}`}
      height="medium"
      fileParts={[...fileParts, `cell${cell.rangeBin}-${cell.dopplerBin}`]}
      remarks={[`Conventional beam of cell ${cell.rangeBin}, ${cell.dopplerBin}, over ${FRAMES[set.frames]}.`]}
    />
  );
}
