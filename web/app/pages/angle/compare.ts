/** What the angle lab's kept settings, A, give. */
import { effect, signal } from '@preact/signals';
import { describeError, type Problem } from '../../data.ts';
import type { Caption } from '../../state/address.ts';
import { comparison } from '../../state/comparison.ts';
import { type Answers, computeApart } from './compute.ts';
import { angleCodec, angleState, captionOf } from './state.ts';

export const compared = comparison(angleCodec, angleState, {
  names: {
    array: 'Array',
    targets: 'Targets (°:dB)',
    seed: 'Seed',
    methods: 'Methods',
    networks: 'Networks',
    coupling: 'Coupling',
  },
});

/** Each method as soon as it is there. */
export const kept = signal<Answers | null>(null);
export const keptProblem = signal<Problem | null>(null);

/** For those who see a plot alone. */
export function caption(): Caption {
  const { data, settings } = captionOf(angleState.peek());
  return { data, settings: compared.captioned(settings) };
}

/** Computes A whenever other settings are kept; the newest wins. */
export function start(): () => void {
  let latest = 0;
  const stop = effect(() => {
    const state = compared.kept.value;
    latest += 1;
    const mine = latest;
    keptProblem.value = null;
    if (!state) {
      kept.value = null;
      return;
    }
    computeApart(state, (answers) => {
      if (mine === latest) kept.value = answers;
    }).catch((error: unknown) => {
      if (mine !== latest) return;
      kept.value = null;
      keptProblem.value = describeError(error);
    });
  });
  return () => {
    latest += 1;
    stop();
  };
}
