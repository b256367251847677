/** All networks at a glance; choosing one shows its card. */
import { useMemo } from 'preact/hooks';
import { count, fixed } from '../../../plots/format.ts';
import { models } from '../../networks/load.ts';
import type { Model } from '../../networks/models.ts';
import { titleOf } from './methods.ts';
import { results } from './results.ts';
import { networksState, update } from './state.ts';
import { type Summary, summary } from './verdict.ts';
import { briefly, sizeOf } from './words.ts';

export function Overview() {
  return (
    <section class="panel" aria-labelledby="networks-title" data-table="networks">
      <div class="panel-head">
        <h3 id="networks-title">Networks</h3>
      </div>
      <div class="table-scroll" tabIndex={0} role="region" aria-label="Networks, scrollable">
        <table class="data">
          <thead>
            <tr>
              <th scope="col" class="text">
                Network
              </th>
              <th scope="col" class="text">
                Task
              </th>
              <th scope="col" class="text">
                Input
              </th>
              <th scope="col">Parameters</th>
              <th scope="col" title="Bytes that are fetched when it is first used">
                File
              </th>
              <th scope="col" title="Simulated samples it was trained on">
                Samples seen
              </th>
              <th scope="col" title="Time of training">
                Hours
              </th>
              <th scope="col" class="text" title="Counted from the experiments below">
                Against classical methods
              </th>
            </tr>
          </thead>
          <tbody>
            {models.value.map((model) => (
              <Row key={model.name} model={model} />
            ))}
          </tbody>
        </table>
      </div>
    </section>
  );
}

function Row({ model: { name, title, card } }: { model: Model }) {
  const selected = networksState.value.model === name;
  const [task, input] = briefly(card);
  const all = results.value;
  const found = useMemo(() => all && summary(all, name), [all]);
  return (
    <tr class="pick" aria-selected={selected} data-network={name} onClick={() => update({ model: name })}>
      <th scope="row" class="text">
        <button
          type="button"
          class="cell-button"
          aria-pressed={selected}
          title="Show its card"
          onClick={() => update({ model: name })}
        >
          {title}
        </button>
      </th>
      <td class="text wrap">{task}</td>
      <td class="text wrap">{input}</td>
      <td>{card.parameters === undefined ? '–' : count(card.parameters)}</td>
      <td>{sizeOf(card)}</td>
      <td>{card.samplesSeen === undefined ? '–' : count(card.samplesSeen)}</td>
      <td>{card.hours === undefined ? '–' : fixed(card.hours, 2)}</td>
      <td class="text wrap" data-field="summary">
        {found ? <Against summary={found} /> : '–'}
      </td>
    </tr>
  );
}

function Against({ summary: { figure, against, behind, conditions } }: { summary: Summary }) {
  return against ? (
    <>
      Loses to {titleOf(against)} in {behind} of {conditions} conditions ({figure.split(':')[0]})
    </>
  ) : (
    <>
      Beaten by none in {conditions} conditions ({figure.split(':')[0]})
    </>
  );
}
