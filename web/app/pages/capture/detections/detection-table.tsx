/** Detections, sortable, with the board's own beside them. */
import { useSignal } from '@preact/signals';
import type { BoardObject, Cell, FrameResult } from 'boresight';
import type { ComponentChildren } from 'preact';
import { fixed, signed } from '../../../../plots/format.ts';
import { download, fileName, toCsv } from '../../../../plots/save.ts';
import { update } from '../state.ts';
import { type Comparison, compare } from './match.ts';

interface Column {
  key: string;
  title: string;
  csv: string;
  group: 'ours' | 'board' | 'difference';
  help: string;
  value(entry: Comparison): number | undefined;
  show(value: number): string;
}

const azimuthDifference = ({ row, board }: Comparison): number | undefined =>
  row && board && row.azimuthDeg - board.azimuthDeg;

function columns(elevated: boolean, folded: boolean, withBoard: boolean): Column[] {
  const ours = (
    key: string,
    title: string,
    csv: string,
    help: string,
    value: (row: NonNullable<Comparison['row']>) => number | undefined,
    show: (value: number) => string,
  ): Column => ({ key, title, csv, help, group: 'ours', show, value: ({ row }) => row && value(row) });
  const list: Column[] = [
    ours(
      'rangeM',
      'Range (m)',
      'range_m',
      'Distance, interpolated between range bins',
      (r) => r.rangeM,
      (v) => fixed(v, 2),
    ),
    ours(
      'rateMps',
      'Rate (m/s)',
      'rate_mps',
      'Range rate, positive when receding',
      (r) => r.rateMps,
      (v) => signed(v, 2),
    ),
    ours(
      'azimuthDeg',
      'Azimuth (°)',
      'azimuth_deg',
      'Positive to the left of boresight',
      (r) => r.azimuthDeg,
      (v) => signed(v, 1),
    ),
  ];
  if (elevated)
    list.push(
      ours(
        'elevationDeg',
        'Elevation (°)',
        'elevation_deg',
        'Positive upwards',
        (r) => r.elevationDeg,
        (v) => signed(v, 1),
      ),
    );
  if (elevated) {
    const place = (key: 'xM' | 'yM' | 'zM', csv: string, title: string, help: string): Column =>
      ours(
        key,
        title,
        csv,
        help,
        (r) => r[key],
        (v) => signed(v, 2),
      );
    list.push(
      place('xM', 'x_m', 'x (m)', 'Forward of the radar'),
      place('yM', 'y_m', 'y (m)', 'To the left of the radar'),
      place('zM', 'z_m', 'z (m)', 'Above the radar'),
    );
  }
  if (folded)
    list.push(
      ours(
        'dopplerFold',
        'Fold',
        'doppler_fold',
        'Times twice the rate limit that the rate is beyond that of its bin',
        (r) => r.dopplerFold,
        (v) => signed(v, 0),
      ),
      ours(
        'foldProbability',
        'Certain (%)',
        'fold_probability',
        'Probability of the likeliest fold; below 99 % the rate keeps that of its bin',
        (r) => r.foldProbability,
        (v) => fixed(100 * v, 1),
      ),
    );
  list.push(
    ours(
      'powerDb',
      'Power (dBFS)',
      'power_dbfs',
      'Of one raw sample at one element, relative to full scale',
      (r) => r.powerDb,
      (v) => fixed(v, 1),
    ),
    ours(
      'snrDb',
      'SNR (dB)',
      'snr_db',
      'Cell power over the noise level estimated around it',
      (r) => r.snrDb,
      (v) => fixed(v, 1),
    ),
  );
  if (withBoard) {
    const board = (
      key: string,
      title: string,
      csv: string,
      help: string,
      value: (object: BoardObject) => number | undefined,
      show: (value: number) => string,
    ): Column => ({ key, title, csv, help, group: 'board', show, value: (entry) => entry.board && value(entry.board) });
    list.push(
      board(
        'boardRangeM',
        'Range (m)',
        'board_range_m',
        'As the board reported it',
        (b) => b.rangeM,
        (v) => fixed(v, 2),
      ),
      board(
        'boardRateMps',
        'Rate (m/s)',
        'board_rate_mps',
        'As the board reported it',
        (b) => b.rateMps ?? undefined,
        (v) => signed(v, 2),
      ),
      board(
        'boardAzimuthDeg',
        'Azimuth (°)',
        'board_azimuth_deg',
        'The board’s x points right; shown here positive to the left',
        (b) => b.azimuthDeg,
        (v) => signed(v, 1),
      ),
      ...(elevated
        ? [
            board(
              'boardElevationDeg',
              'Elevation (°)',
              'board_elevation_deg',
              'From the place that the board reported, positive upwards',
              (b) => b.elevationDeg,
              (v) => signed(v, 1),
            ),
            board(
              'boardZM',
              'z (m)',
              'board_z_m',
              'As the board reported it',
              (b) => b.zM,
              (v) => signed(v, 2),
            ),
          ]
        : []),
      {
        key: 'rangeDifferenceM',
        title: 'Range (m)',
        csv: 'range_difference_m',
        group: 'difference',
        help: 'Ours less the board’s',
        show: (v) => signed(v, 2),
        value: ({ row, board: b }) => row && b && row.rangeM - b.rangeM,
      },
      {
        key: 'azimuthDifferenceDeg',
        title: 'Azimuth (°)',
        csv: 'azimuth_difference_deg',
        group: 'difference',
        help: 'Ours less the board’s',
        show: (v) => signed(v, 1),
        value: azimuthDifference,
      },
    );
  }
  return list;
}

const GROUPS = { ours: 'Computed here', board: 'Board’s own', difference: 'Difference' } as const;

export function DetectionTable({
  view,
  cell,
  board,
  gateM,
  elevated,
  foot,
  fileParts,
}: {
  view: FrameResult;
  cell: Cell;
  /** Null without a log. */
  board: readonly BoardObject[] | null;
  gateM: number;
  elevated: boolean;
  /** What is to be said of the board’s log, and its controls. */
  foot: ComponentChildren;
  fileParts: readonly (string | number)[];
}) {
  const sort = useSignal<{ key: string; down: boolean }>({ key: 'powerDb', down: true });
  const folded = view.detections.some(({ foldProbability }) => foldProbability !== undefined);
  const shown = columns(elevated, folded, board !== null);
  const entries = compare(view.detections, board ?? [], gateM);
  const by = shown.find(({ key }) => key === sort.value.key) ?? shown[0]!;
  const sorted = [...entries].sort((a, b) => {
    const [x, y] = [by.value(a), by.value(b)];
    if (x === undefined || y === undefined) return Number(x === undefined) - Number(y === undefined);
    return sort.value.down ? y - x : x - y;
  });
  const groups = (['ours', 'board', 'difference'] as const)
    .map((group) => ({ group, size: shown.filter((column) => column.group === group).length }))
    .filter(({ size }) => size > 0);
  const starts = new Set(groups.map(({ group }) => shown.find((column) => column.group === group)?.key));
  const csv = (): string =>
    toCsv(
      ['range_bin', 'doppler_bin', ...shown.map((column) => column.csv)],
      sorted.map((entry) => [
        entry.row?.rangeBin,
        entry.row?.dopplerBin,
        ...shown.map((column) => column.value(entry)),
      ]),
    );
  return (
    <section class="panel" aria-labelledby="detections-title" data-table="detections">
      <div class="panel-head">
        <h3 id="detections-title">Detections</h3>
        <span class="muted" data-count>
          {view.detections.length} here{board ? `, ${board.length} reported by the board` : ''}
        </span>
        {folded && <span class="muted">rates told to ±{fixed(view.unambiguousRateMps, 1)} m/s</span>}
        <div class="tools">
          <button
            type="button"
            data-export="csv"
            onClick={() => download(csv(), fileName(['detections', ...fileParts], 'csv'))}
          >
            CSV
          </button>
        </div>
      </div>
      <div class="table-scroll capped" tabIndex={0} role="region" aria-label="Detections, scrollable">
        <table class="data">
          <thead>
            <tr>
              {groups.map(({ group, size }) => (
                <th key={group} colSpan={size + (group === 'ours' ? 1 : 0)} scope="colgroup" class="group-head">
                  {GROUPS[group]}
                </th>
              ))}
            </tr>
            <tr>
              <th scope="col">
                <span class="visually-hidden">Cell</span>
              </th>
              {shown.map((column) => (
                <th
                  key={column.key}
                  scope="col"
                  class={starts.has(column.key) && column.group !== 'ours' ? 'group-start' : ''}
                  title={column.help}
                  aria-sort={sort.value.key === column.key ? (sort.value.down ? 'descending' : 'ascending') : undefined}
                >
                  <button
                    type="button"
                    class="sort"
                    onClick={() => {
                      const same = sort.value.key === column.key;
                      sort.value = { key: column.key, down: same ? !sort.value.down : column.key !== 'rangeM' };
                    }}
                  >
                    {column.title}
                    <span aria-hidden="true">
                      {sort.value.key === column.key ? (sort.value.down ? ' ▾' : ' ▴') : ''}
                    </span>
                  </button>
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            {sorted.map((entry, i) => {
              const { row } = entry;
              const chosen = row !== undefined && row.rangeBin === cell.rangeBin && row.dopplerBin === cell.dopplerBin;
              return (
                <tr
                  key={row ? `${row.rangeBin}:${row.dopplerBin}:${i}` : `board${i}`}
                  class={row ? 'pick' : 'reference'}
                  data-detection={row ? `${row.rangeBin}:${row.dopplerBin}` : 'board'}
                  aria-selected={chosen ? 'true' : undefined}
                  onClick={() => row && update({ cell: { rangeBin: row.rangeBin, dopplerBin: row.dopplerBin } })}
                >
                  <td class="text">
                    {row ? (
                      <button
                        type="button"
                        class="cell-button"
                        aria-pressed={chosen}
                        aria-label={`${row.rangeBin}, ${row.dopplerBin}: show the cell at ${fixed(row.rangeM, 2)} metres`}
                        title={`Range bin ${row.rangeBin}, Doppler bin ${row.dopplerBin}`}
                      >
                        {row.rangeBin}, {row.dopplerBin}
                      </button>
                    ) : (
                      <span class="muted">not here</span>
                    )}
                  </td>
                  {shown.map((column) => {
                    const value = column.value(entry);
                    return (
                      <td
                        key={column.key}
                        data-field={column.key}
                        data-value={value}
                        class={starts.has(column.key) && column.group !== 'ours' ? 'group-start' : ''}
                      >
                        {value === undefined ? '–' : column.show(value)}
                      </td>
                    );
                  })}
                </tr>
              );
            })}
            {entries.length === 0 && (
              <tr>
                <td class="text" colSpan={shown.length + 1}>
                  No detections with these settings.
                </td>
              </tr>
            )}
          </tbody>
        </table>
      </div>
      {foot}
    </section>
  );
}
