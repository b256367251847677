/** The chosen cell as planned and calibrated: its beam, its sidelobes, and its targets. */
import type { Estimate } from 'boresight';
import { useMemo } from 'preact/hooks';
import type { NamedEstimate } from '../../../../elements/kinds/spectrum.ts';
import { fixed, signed } from '../../../../plots/format.ts';
import { closes } from '../../../../plots/spectra.ts';
import { ACCENT_STYLE, methodStyle } from '../../../../plots/theme.ts';
import { ElementFrame } from '../../../ui/plot-frame.tsx';
import { usedArray } from '../detections/process.ts';
import {
  type BeforeAfter,
  beforeAfter,
  beforeAfterProblem,
  beforeAfterWorking,
  type FrameSet,
} from './before-after.ts';
import type { FileParts } from './words.ts';

const FRAMES: Readonly<Record<FrameSet, string>> = {
  used: 'frames it was made from',
  others: 'frames not used for it',
  all: 'all frames',
};

export function CellBeforeAfter({ fileParts }: { fileParts: FileParts }) {
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
