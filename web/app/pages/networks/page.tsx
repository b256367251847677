import { useSignalEffect } from '@preact/signals';
import { hasModule } from '../../networks/module.ts';
import { useAddress } from '../../state/address.ts';
import { announce } from '../../state/announce.ts';
import { MainColumn } from '../../ui/main-column.tsx';
import { ModuleNote } from '../../ui/module-note.tsx';
import { AboutNetworks } from './about.tsx';
import { attempt, selected, start, targetsIn } from './attempt.ts';
import { AttemptPanel } from './attempt-panel.tsx';
import { CardPanel, MetricsPanel } from './card.tsx';
import { Controls } from './controls.tsx';
import { Experiments } from './experiments.tsx';
import { LearningPanel } from './learning.tsx';
import { Overview } from './overview.tsx';
import { ownProblem } from './own.tsx';
import { StandingPanel } from './standing-panel.tsx';
import { captionOf, networksCodec, networksState } from './state.ts';
import { TimingPanel } from './timing-panel.tsx';

export function NetworksPage() {
  useAddress('networks', {
    codec: networksCodec,
    restore: (params) => {
      networksState.value = networksCodec.read(params);
    },
    start,
    write: () => networksCodec.write(networksState.value),
    caption: () => {
      const [state, model] = [networksState.peek(), selected.peek()];
      return captionOf({ ...state, targets: model ? targetsIn(state, model.card) : state.targets }, model);
    },
  });
  useSignalEffect(() => {
    const made = attempt.value;
    const row = made?.rows[0];
    if (row?.estimate)
      announce(`${row.title}: ${row.estimate.sources.length} estimates for ${made?.truth.length} targets.`);
    const count = made?.counts[0];
    if (count) announce(`${count.title}: ${count.sources} targets counted, ${made?.truth.length} are there.`);
  });
  const model = selected.value;
  const problem = ownProblem.value;
  return (
    <div class="page">
      <Controls />
      <MainColumn>
        {problem && (
          <p class="alert" role="alert" data-error={problem.code}>
            <strong>{problem.file}: </strong>
            {problem.message} <code>{problem.code}</code>
          </p>
        )}
        {!hasModule && (
          <p class="notice">
            <ModuleNote />
          </p>
        )}
        <StandingPanel />
        <AttemptPanel />
        <Overview />
        {model && (
          <div class="wide-narrow">
            <CardPanel model={model} />
            <MetricsPanel model={model} />
          </div>
        )}
        {model && <LearningPanel model={model} />}
        <TimingPanel />
        <Experiments />
        <AboutNetworks />
      </MainColumn>
    </div>
  );
}
