import { useSignalEffect } from '@preact/signals';
import { useEffect, useRef, useState } from 'preact/hooks';
import { MODELS } from '../../networks/models.ts';
import { lastParams, route, writeParams } from '../../state/route.ts';
import { CardPanel, MetricsPanel } from './card.tsx';
import { Experiments } from './experiments.tsx';
import { Overview } from './overview.tsx';
import { networksCodec, networksState } from './state.ts';

function restore({ page, params }: typeof route.value): void {
  if (page === 'networks') networksState.value = networksCodec.read(params.size ? params : (lastParams('networks') ?? params));
}

export function NetworksPage() {
  const ready = useRef(false);
  useState(() => restore(route.peek()));
  useEffect(() => {
    ready.current = true;
  }, []);
  useSignalEffect(() => {
    const now = route.value;
    if (ready.current) restore(now);
  });
  useSignalEffect(() => writeParams('networks', networksCodec.write(networksState.value)));
  const model = MODELS.find(({ name }) => name === networksState.value.model);
  return (
    <div class="page">
      <div />
      <div class="main-column">
        <Overview />
        {model && <div class="wide-narrow"><CardPanel model={model} /><MetricsPanel model={model} /></div>}
        <Experiments />
      </div>
    </div>
  );
}
