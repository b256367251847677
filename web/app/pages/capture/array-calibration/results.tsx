/** A calibration with its uncertainty, how it does on other data, and the chosen cell before and after. */
import type { ArrayCalibration, CheckFigures } from 'boresight';
import { count, fixed, signed } from '../../../../plots/format.ts';
import type { Made } from './calibrate.ts';
import { CellBeforeAfter } from './cell.tsx';
import { Channels } from './channels.tsx';
import { type FileParts, withDeviation } from './words.ts';

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
