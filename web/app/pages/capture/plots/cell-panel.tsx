/** Angle spectrum of the chosen cell by several methods, and what each finds there. */

import type { ArrayGeometry, Cell, FrameResult, Method } from 'boresight';
import { useMemo } from 'preact/hooks';
import { defineElement } from '../../../../elements/base/define.ts';
import { type NamedEstimate, SpectrumElement } from '../../../../elements/kinds/spectrum.ts';
import { fixed, signed } from '../../../../plots/format.ts';
import { closes } from '../../../../plots/spectra.ts';
import { methodStyle } from '../../../../plots/theme.ts';
import { api } from '../../../data.ts';
import { ElementFrame } from '../../../ui/plot-frame.tsx';
import { Swatch } from '../../../ui/swatch.tsx';
import { type CellResult, isPending } from '../detections/process.ts';
import { captureState } from '../state.ts';

defineElement('boresight-spectrum', SpectrumElement);

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
  const estimates = useMemo(
    () =>
      infos.map(
        ({ name, title, spectrum }): NamedEstimate => ({
          estimate: results.get(name)?.estimate ?? null,
          id: name,
          label: title,
          line: spectrum,
        }),
      ),
    [results],
  );
  const lines = useMemo(
    () => (boardDeg === undefined ? [] : [{ azimuthDeg: boardDeg, label: `board ${signed(boardDeg, 1)}°` }]),
    [boardDeg],
  );
  const place = `${fixed(view.rangeM[cell.rangeBin] ?? Number.NaN, 2)} m, ${signed(view.rateMps[cell.dopplerBin] ?? Number.NaN, 2)} m/s`;
  return (
    <ElementFrame
      tag="boresight-spectrum"
      own={{
        estimates,
        lines,
        levels: 'absolute',
        'floor-db': 50,
        sector: 90,
        'unambiguous-deg': unambiguousDeg,
        unit: 'dBFS',
        'y-label': 'Power (dBFS)',
        closed: positions !== undefined && closes(positions),
      }}
      title="Angle spectrum"
      detail={place}
      name="cell-spectrum"
      height="fill"
      listed="image"
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
                  <tr key={info.name} data-row={info.name} aria-busy={result !== undefined && isPending(result)}>
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
