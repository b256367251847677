/** Angle spectrum of the chosen cell by several methods, and what each finds there. */

import type { ArrayGeometry, Cell, FrameResult, Method } from 'boresight';
import { useMemo } from 'preact/hooks';
import { AZIMUTH } from '../../../plots/axes.ts';
import { fixed, signed } from '../../../plots/format.ts';
import { bands, markers, verticalLines } from '../../../plots/layers.ts';
import { toCsv } from '../../../plots/save.ts';
import { methodStyle } from '../../../plots/theme.ts';
import { api } from '../../data.ts';
import { closes, curve, highest, onOneGrid, series, sourceMarkers } from '../../estimates.ts';
import { PlotFrame } from '../../ui/plot-frame.tsx';
import { Swatch } from '../../ui/swatch.tsx';
import type { CellResult } from './process.ts';
import { captureState } from './state.ts';

export function CellPanel({
  view,
  cell,
  results,
  boardDeg,
  unambiguousDeg,
  positions,
  label,
  fileParts,
}: {
  view: FrameResult;
  cell: Cell;
  results: ReadonlyMap<Method, CellResult>;
  /** Azimuth of the board's object in this cell, if it has one. */
  boardDeg: number | undefined;
  unambiguousDeg: number;
  /** Of the array's elements. */
  positions: ArrayGeometry['positions'] | undefined;
  label: string;
  fileParts: readonly (string | number)[];
}) {
  const infos = api.methods().filter(({ name }) => results.has(name));
  const shown = useMemo(
    () =>
      onOneGrid(
        infos.map(({ name, title }) => {
          const estimate = results.get(name)?.estimate;
          return estimate ? curve(estimate, title, positions !== undefined && closes(positions)) : null;
        }),
      ),
    [results],
  );
  const content = useMemo(() => {
    const sources = [...results].flatMap(([method, { estimate }]) => sourceMarkers(method, estimate?.sources ?? []));
    const top = Math.max(...shown.map(({ valuesDb }) => highest(valuesDb)), ...sources.map(({ y }) => y));
    const ceiling = Number.isFinite(top) ? Math.ceil((top + 4) / 5) * 5 : 0;
    const outside: [number, number][] =
      unambiguousDeg < 89.9
        ? [
            [-90, -unambiguousDeg],
            [unambiguousDeg, 90],
          ]
        : [];
    return {
      x: shown[0]?.azimuthDeg ?? [],
      series: series(shown),
      extent: { x: [-90, 90] as const, y: [ceiling - 50, ceiling] as const },
      below: [bands(outside, (t) => t.shade)],
      above: [
        ...(boardDeg === undefined
          ? []
          : [
              verticalLines([{ x: boardDeg, label: `board ${signed(boardDeg, 1)}°` }], {
                dash: [2, 4],
                color: (t) => t.muted,
              }),
            ]),
        markers(sources),
      ],
    };
  }, [results, shown, boardDeg]);
  const place = `${fixed(view.rangeM[cell.rangeBin] ?? Number.NaN, 2)} m, ${signed(view.rateMps[cell.dopplerBin] ?? Number.NaN, 2)} m/s`;
  return (
    <PlotFrame
      title="Angle spectrum"
      detail={place}
      name="cell-spectrum"
      height="fill"
      content={content}
      legendElsewhere
      legend={infos.map(({ name, title, spectrum }) => ({
        label: title,
        style: methodStyle(name),
        line: spectrum,
      }))}
      axes={{
        x: AZIMUTH,
        y: { label: 'Power (dBFS)' },
      }}
      readout={({ x, index }) =>
        `Azimuth ${signed(x, 2)}°   ${shown.map(({ title, valuesDb }) => `${title.split(' ')[0]} ${fixed(valuesDb[index ?? -1] ?? Number.NaN, 1)}`).join('   ')} dBFS`
      }
      csv={() =>
        toCsv(
          ['azimuth_deg', ...shown.map(({ method }) => `${method.replaceAll('-', '_')}_dbfs`)],
          Array.from(shown[0]?.azimuthDeg ?? [], (azimuth, i) => [
            azimuth,
            ...shown.map(({ valuesDb }) => valuesDb[i]),
          ]),
        )
      }
      fileParts={[...fileParts, `cell${cell.rangeBin}-${cell.dopplerBin}`]}
      remarks={[`${label}, cell ${cell.rangeBin}, ${cell.dopplerBin}.`]}
      overlay={
        <div class="table-scroll" tabIndex={0} role="region" aria-label="Estimates of the cell, scrollable">
          <table class="data compact" data-table="cell">
            <thead>
              <tr>
                <th scope="col" class="text">
                  Method
                </th>
                <th scope="col">Azimuth (°)</th>
                <th scope="col">dBFS</th>
                <th scope="col" class="text">
                  Further (°)
                </th>
              </tr>
            </thead>
            <tbody>
              {infos.map((info) => {
                const result = results.get(info.name);
                const sources = result?.estimate?.sources ?? [];
                return (
                  <tr key={info.name} data-row={info.name} class={result?.stale ? 'stale' : ''}>
                    <th scope="row" class="text">
                      <Swatch style={methodStyle(info.name)} line={info.spectrum} /> {info.title}
                    </th>
                    {result?.problem ? (
                      <td class="text problem" colSpan={3}>
                        {result.problem.message}
                      </td>
                    ) : (
                      <>
                        <td data-field="azimuth" data-value={sources[0]?.azimuthDeg}>
                          {sources[0] ? signed(sources[0].azimuthDeg, 1) : '–'}
                        </td>
                        <td>{sources[0] ? fixed(sources[0].powerDb, 1) : '–'}</td>
                        <td class="text">
                          {sources
                            .slice(1, 4)
                            .map((source) => signed(source.azimuthDeg, 1))
                            .join(', ')}
                          {sources.length > 4 ? ' …' : ''}
                        </td>
                      </>
                    )}
                  </tr>
                );
              })}
            </tbody>
          </table>
          {captureState.value.methods.length === 0 && <p class="remark">Choose a method to see the cell’s spectrum.</p>}
        </div>
      }
    />
  );
}
