/** Under a network in a list of methods: which one is used, and how far it is loaded. */

import { byteSize } from '../../plots/format.ts';
import { cancelLoading, load, loadings } from '../networks/load.ts';
import { arrayOf, type Model } from '../networks/models.ts';
import { hasModule } from '../networks/module.ts';
import { ModuleNote } from './module-note.tsx';

export function NetworkNote({
  model,
  choices,
  chosen,
  onChange,
}: {
  model: Model;
  /** All that fit. */
  choices: readonly Model[];
  /** Whether its method is. */
  chosen: boolean;
  onChange(model: Model): void;
}) {
  const size = model.card.bytes === undefined ? '' : `, ${byteSize(model.card.bytes)}`;
  return (
    <div class="note network-note" data-network-note={model.name}>
      {choices.length > 1 ? (
        <select
          aria-label={`Network for ${model.card.network}`}
          name={`network-${model.card.network}`}
          value={model.name}
          onChange={(event) => {
            const next = choices.find(({ name }) => name === event.currentTarget.value);
            if (next) onChange(next);
          }}
        >
          {choices.map(({ name, title }) => (
            <option key={name} value={name} selected={name === model.name}>
              {title}
            </option>
          ))}
        </select>
      ) : (
        <span>{model.title}: </span>
      )}{' '}
      {chosen ? (
        <LoadState name={model.name} />
      ) : (
        <span>
          for {arrayOf(model.card)}
          {size}; loads when chosen{!hasModule && '. '}
          <ModuleNote />
        </span>
      )}
    </div>
  );
}

/** Progress of a network's download with a way to cancel it, or what became of it. */
export function LoadState({ name }: { name: string }) {
  const state = loadings.value.get(name);
  switch (state?.status) {
    case 'fetching':
    case 'waiting':
    case 'starting': {
      const far =
        state.status === 'starting' ? (
          'starting'
        ) : state.status === 'waiting' ? (
          <ModuleNote />
        ) : (
          `${byteSize(state.done)} of ${state.total ? byteSize(state.total) : 'unknown size'}`
        );
      return (
        <span class="progress-line" data-loading={name}>
          <progress
            aria-label="Loading the network"
            {...(state.status === 'fetching' && state.total ? { max: state.total, value: state.done } : {})}
          />
          <span>{far}</span>
          <button type="button" data-action="cancel-loading" onClick={() => cancelLoading(name)}>
            Cancel
          </button>
        </span>
      );
    }
    case 'ready':
      return <span data-ready={name}>ready</span>;
    case 'failed':
    case 'cancelled':
      return (
        <span data-stopped={name}>
          {state.status === 'cancelled' ? (
            'loading was cancelled '
          ) : (
            <span class="problem">
              {state.problem?.message} <code>{state.problem?.code}</code>{' '}
            </span>
          )}
          <button type="button" data-action="load" onClick={() => void load(name).catch(() => {})}>
            Load
          </button>
        </span>
      );
    default:
      return null;
  }
}
