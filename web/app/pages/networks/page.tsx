import { useSignalEffect } from '@preact/signals';
import { useEffect, useRef, useState } from 'preact/hooks';
import { announce } from '../../state/announce.ts';
import { lastParams, route, writeParams } from '../../state/route.ts';
import { AboutNetworks } from './about.tsx';
import { attempt, selected, start } from './attempt.ts';
import { AttemptPanel } from './attempt-panel.tsx';
import { CardPanel, MetricsPanel } from './card.tsx';
import { Controls } from './controls.tsx';
import { Experiments } from './experiments.tsx';
import { Overview } from './overview.tsx';
import { ownProblem } from './own.tsx';
import { networksCodec, networksState } from './state.ts';
import { TimingPanel } from './timing-panel.tsx';

function restore({ page, params }: typeof route.value): void {
  if (page === 'networks') networksState.value = networksCodec.read(params.size ? params : (lastParams('networks') ?? params));
}

export function NetworksPage() {
  const ready = useRef(false);
  useState(() => restore(route.peek()));
  useEffect(() => {
    ready.current = true;
    return start();
  }, []);
  useSignalEffect(() => {
    const now = route.value;
    if (ready.current) restore(now);
  });
  useSignalEffect(() => writeParams('networks', networksCodec.write(networksState.value)));
  useSignalEffect(() => {
    const made = attempt.value;
    const row = made?.rows[0];
    if (row?.estimate) announce(`${row.title}: ${row.estimate.sources.length} estimates for ${made?.truth.length} targets.`);
    const count = made?.counts[0];
    if (count) announce(`${count.title}: ${count.sources} targets counted, ${made?.truth.length} are there.`);
  });
  const model = selected.value;
  const problem = ownProblem.value;
  return (
    <div class="page">
      <Controls />
      <div class="main-column">
        {problem && (
          <p class="alert" role="alert" data-error={problem.code}><strong>{problem.file}: </strong>{problem.message} <code>{problem.code}</code></p>
        )}
        <Overview />
        {model && <div class="wide-narrow"><CardPanel model={model} /><MetricsPanel model={model} /></div>}
        <AttemptPanel />
        <TimingPanel />
        <Experiments />
        <AboutNetworks />
      </div>
    </div>
  );
}
