/** What comes of A and of B. */
import type { FrameResult } from 'boresight';
import { fixed, signed } from '../../../../plots/format.ts';
import { ComparisonPanel } from '../../../ui/comparison.tsx';
import { compared, keptProblem, keptView } from './compare.ts';

/** The middle of the profile: mostly noise. */
function floorDb({ rangeProfileDb }: FrameResult): number {
  const sorted = [...rangeProfileDb].filter(Number.isFinite).sort((a, b) => a - b);
  return sorted[Math.floor(sorted.length / 2)] ?? Number.NaN;
}

const FIGURES: readonly { id: string; title: string; digits: number; of(view: FrameResult): number }[] = [
  { id: 'detections', title: 'Detections', digits: 0, of: ({ detections }) => detections.length },
  {
    id: 'peak',
    title: 'Highest of the range profile (dBFS)',
    digits: 1,
    of: ({ rangeProfileDb }) => rangeProfileDb.reduce((most, value) => Math.max(most, value), Number.NEGATIVE_INFINITY),
  },
  { id: 'floor', title: 'Median of the range profile (dBFS)', digits: 1, of: floorDb },
  { id: 'bins', title: 'Range bins', digits: 0, of: ({ rangeM }) => rangeM.length },
  { id: 'rates', title: 'Rate bins', digits: 0, of: ({ rateMps }) => rateMps.length },
];

export function ComparePanel({ view }: { view: FrameResult }) {
  const a = keptView.value;
  return (
    <ComparisonPanel of={compared} problem={keptProblem.value}>
      {a ? (
        <table class="data">
          <thead>
            <tr>
              <th scope="col" class="text">
                Figure
              </th>
              {['A', 'B', 'B − A'].map((title) => (
                <th key={title} scope="col">
                  {title}
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            {FIGURES.map(({ id, title, digits, of }) => {
              const [ofA, ofB] = [of(a), of(view)];
              return (
                <tr key={id} data-row={id}>
                  <th scope="row" class="text">
                    {title}
                  </th>
                  <td data-field="a" data-value={ofA}>
                    {fixed(ofA, digits)}
                  </td>
                  <td data-field="b" data-value={ofB}>
                    {fixed(ofB, digits)}
                  </td>
                  <td>{signed(ofB - ofA, digits)}</td>
                </tr>
              );
            })}
          </tbody>
        </table>
      ) : (
        !keptProblem.value && <p class="remark">Computing A</p>
      )}
    </ComparisonPanel>
  );
}
