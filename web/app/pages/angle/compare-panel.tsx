/** What comes of A and of B. */

import { fixed, signed } from '../../../plots/format.ts';
import { methodStyle } from '../../../plots/theme.ts';
import { api } from '../../data.ts';
import { ComparisonPanel } from '../../ui/comparison.tsx';
import { Swatch } from '../../ui/swatch.tsx';
import { compared, kept, keptProblem } from './compare.ts';
import type { Answers, MethodResult } from './compute.ts';
import { rms, type Score, scoreOf } from './score.ts';

export function ComparePanel(present: Answers) {
  return (
    <ComparisonPanel of={compared} problem={keptProblem.value}>
      {kept.value && <Figures a={kept.value} b={present} />}
    </ComparisonPanel>
  );
}

const degrees = (value: number): string => (Number.isFinite(value) ? fixed(value, value < 0.01 ? 4 : 3) : '–');

function Figures({ a, b }: { a: Answers; b: Answers }) {
  const bound = ({ scene }: Answers): number => rms([...(scene.bound ?? [])]);
  const rows = api.methods().filter(({ name }) => a.results.has(name) || b.results.has(name));
  return (
    <table class="data">
      <thead>
        <tr>
          <th scope="col" class="text" rowSpan={2}>
            Method
          </th>
          {['Root mean square error (°)', 'Targets found', 'Extra'].map((title, i) => (
            <th key={title} scope="colgroup" class="group-head" colSpan={i ? 2 : 3}>
              {title}
            </th>
          ))}
        </tr>
        <tr>
          {['A', 'B', 'B − A', 'A', 'B', 'A', 'B'].map((title, i) => (
            <th key={`${title}${i}`} scope="col" class={title === 'A' ? 'group-start' : ''}>
              {title}
            </th>
          ))}
        </tr>
      </thead>
      <tbody>
        <tr class="reference" data-row="bound">
          <th scope="row" class="text">
            CRB: {'σ'}
          </th>
          <Errors a={bound(a)} b={bound(b)} />
          <td class="group-start" />
          <td />
          <td class="group-start" />
          <td />
        </tr>
        {rows.map(({ name, title, spectrum }) => {
          const [ofA, ofB] = [score(a, a.results.get(name)), score(b, b.results.get(name))];
          return (
            <tr key={name} data-row={name}>
              <th scope="row" class="text">
                <Swatch style={methodStyle(name)} line={spectrum} /> {title}
              </th>
              <Errors a={ofA?.rmsDeg ?? Number.NaN} b={ofB?.rmsDeg ?? Number.NaN} />
              <td class="group-start">{found(ofA)}</td>
              <td>{found(ofB)}</td>
              <td class="group-start">{ofA?.extra ?? '–'}</td>
              <td>{ofB?.extra ?? '–'}</td>
            </tr>
          );
        })}
      </tbody>
    </table>
  );
}

function Errors({ a, b }: { a: number; b: number }) {
  const value = (number: number): number | undefined => (Number.isFinite(number) ? number : undefined);
  return (
    <>
      <td class="group-start" data-field="rms-a" data-value={value(a)}>
        {degrees(a)}
      </td>
      <td data-field="rms-b" data-value={value(b)}>
        {degrees(b)}
      </td>
      <td data-field="rms-difference" data-value={value(b - a)}>
        {Number.isFinite(b - a) ? signed(b - a, 3) : '–'}
      </td>
    </>
  );
}

function score({ scene }: Answers, result: MethodResult | undefined): Score | null {
  return result?.estimate ? scoreOf(scene, result.estimate.sources) : null;
}

const found = (of: Score | null): string => (of ? `${of.found} of ${of.targets}` : '–');
