/** How clean each method's image is, and what it took. */

import { count, decibels, fixed, milliseconds } from '../../../plots/format.ts';
import { download, fileName, toCsv } from '../../../plots/save.ts';
import { methodStyle } from '../../../plots/theme.ts';
import { api } from '../../data.ts';
import { Swatch } from '../../ui/swatch.tsx';
import { input } from './input.ts';
import { images, isPending, type MethodImage, working } from './process.ts';
import { birdseyeState } from './state.ts';

interface Column {
  key: string;
  title: string;
  csv: string;
  help: string;
  /** Only where the truth is known. */
  measured?: boolean;
  value(image: MethodImage): number | undefined;
  show(value: number): string;
}

const percent = (value: number): string => `${fixed(100 * value, 1)}\u00a0%`;

const COLUMNS: readonly Column[] = [
  {
    key: 'outsideDb',
    title: 'Energy outside',
    csv: 'outside_db',
    measured: true,
    value: ({ measure }) => measure?.outsideDb,
    show: decibels,
    help: 'Sidelobe measure: energy of the image farther from all true points than the radars resolve, over all its energy. Lower is cleaner.',
  },
  {
    key: 'peakOutsideDb',
    title: 'Strongest outside',
    csv: 'peak_outside_db',
    measured: true,
    value: ({ measure }) => measure?.peakOutsideDb,
    show: decibels,
    help: 'Strongest cell outside the gates over the strongest of all.',
  },
  {
    key: 'litOutside',
    title: 'Lit outside',
    csv: 'lit_outside_share',
    measured: true,
    value: ({ measure }) => measure?.litOutside,
    show: percent,
    help: 'Share of the cells outside the gates that stand less than 40 dB below the strongest of all.',
  },
  {
    key: 'litTargets',
    title: 'True points lit',
    csv: 'lit_targets_share',
    measured: true,
    value: ({ measure }) => measure?.litTargets,
    show: percent,
    help: 'Share of the true points in view in whose gate a cell stands less than 40 dB below the strongest of all.',
  },
  {
    key: 'cells',
    title: 'Cells',
    csv: 'cells',
    value: ({ cells }) => cells,
    show: count,
    help: 'Detected cells of range and Doppler, each with a snapshot of its own, of all radars that are on.',
  },
  {
    key: 'sources',
    title: 'Directions',
    csv: 'directions',
    value: ({ sources }) => sources,
    show: count,
    help: 'Targets found in these cells.',
  },
  {
    key: 'unresolved',
    title: 'Unresolved',
    csv: 'unresolved_cells',
    value: ({ unresolved }) => unresolved,
    show: count,
    help: 'Cells in which the method found no direction, or not all it looked for.',
  },
  {
    key: 'outside',
    title: 'Off the map',
    csv: 'off_map',
    value: ({ outside }) => outside,
    show: count,
    help: 'Targets, or points of spectra, beyond the field of view or the last range: they are on no image.',
  },
  {
    key: 'time',
    title: 'Time',
    csv: 'time_ms',
    value: ({ milliseconds: time }) => time,
    show: milliseconds,
    help: 'Of the estimates of all these cells, on workers that share this machine.',
  },
];

export function ResultsTable() {
  const measured = input.value?.street != null;
  const columns = COLUMNS.filter((column) => measured || !column.measured);
  const rows = api.methods().flatMap((info) => {
    const image = images.value.get(info.name);
    return image ? [{ info, image }] : [];
  });
  const { seed, source } = birdseyeState.value;
  const csv = (): string =>
    toCsv(
      ['method', 'from', ...columns.map((column) => column.csv)],
      rows
        .filter(({ image }) => !isPending(image))
        .map(({ info, image }) => [info.name, image.from, ...columns.map(({ value }) => value(image))]),
    );
  const warnings = rows.flatMap(({ info, image }) =>
    (image.warnings ?? []).map(({ code, message }) => ({ title: info.title, code, message })),
  );
  return (
    <section class="panel" aria-labelledby="images-title" data-table="results">
      <div class="panel-head">
        <h3 id="images-title">How clean the images are</h3>
        <div class="tools">
          <button
            type="button"
            data-export="csv"
            title="Save the table"
            onClick={() => download(csv(), fileName(['birdseye', source, `seed${seed}`], 'csv'))}
          >
            CSV
          </button>
        </div>
      </div>
      <div class="table-scroll" tabIndex={0} role="region" aria-label="Measures of the images, scrollable">
        <table class="data">
          <thead>
            <tr>
              <th scope="col" class="text">
                Method
              </th>
              {columns.map(({ key, title, help }) => (
                <th key={key} scope="col" title={help}>
                  {title}
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            {rows.map(({ info, image }) => (
              <tr key={info.name} aria-busy={working.value && isPending(image)} data-row={info.name}>
                <th scope="row" class="text">
                  <Swatch style={methodStyle(info.name)} line={info.spectrum} /> {info.title}
                </th>
                {image.problem ? (
                  <td class="text problem" colSpan={columns.length}>
                    {image.problem.message} <code>{image.problem.code}</code>
                  </td>
                ) : (
                  columns.map(({ key, value, show }) => {
                    const is = value(image);
                    return (
                      <td key={key} data-field={key} data-value={is}>
                        {is === undefined ? '–' : show(is)}
                      </td>
                    );
                  })
                )}
              </tr>
            ))}
            {rows.length === 0 && (
              <tr>
                <td class="text muted" colSpan={columns.length + 1}>
                  No method is chosen.
                </td>
              </tr>
            )}
          </tbody>
        </table>
      </div>
      {warnings.length > 0 && (
        <ul class="warnings" aria-label="Warnings">
          {warnings.map(({ title, code, message }) => (
            <li key={title + code}>
              {title}: {message} <code>{code}</code>
            </li>
          ))}
        </ul>
      )}
    </section>
  );
}
