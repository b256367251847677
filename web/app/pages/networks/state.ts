/** State of the page Networks: all of it in the address but a user's own files. */
import { signal } from '@preact/signals';
import { models } from '../../networks/load.ts';
import { MODELS, type Model } from '../../networks/models.ts';
import { optionsOf } from '../../options.ts';
import type { Caption } from '../../state/address.ts';
import { choice, codec, flag, number, text } from '../../state/codec.ts';
import { seed } from '../../state/seed.ts';

export const TARGET_RANGE = [0, 16] as const;
/** Sources in a covariance. */
export const SOURCE_RANGE = [1, 3] as const;
export const EXPERIMENT_SNRS = ['15', '25', '35'] as const;
export const TARGETS = ['2', '3', '4', '5', '6', '7', '8', '9', '10'] as const;
export const REGION_SNRS = ['-10', '-5', '0', '5', '10', '15'] as const;

/** Arrays that a network for any array is tried on. */
export const ARRAYS = ['lrr48', 'cascade86', 'awr1843', 'awr1642', 'ula16', 'ula32'] as const;

const first = MODELS[0]?.name ?? '';

export const networksCodec = codec(
  {
    model: text(first, (name) => models.peek().some((model) => model.name === name)),
    targets: number(6, TARGET_RANGE, 'integer'),
    snr: number(15, [-30, 60]),
    seed,
    refine: optionsOf('SharedEstimatorOptions').field('refine'),
    /** Whether the scene is run, and the network for it loaded. */
    run: flag(false),
    /** Of the experiments' plots. */
    at: choice('15', EXPERIMENT_SNRS),
    of: choice('6', TARGETS),
    regionAt: choice('0', REGION_SNRS),
    range: choice('apart', ['apart', 'together']),
    /** Of a network that takes any. */
    array: choice('lrr48', ARRAYS),
  },
  ['model'],
);

export type NetworksState = typeof networksCodec.defaults;
export const networksState = signal<NetworksState>(networksCodec.defaults);

/** For those who see a plot alone. */
export function captionOf({ targets, snr, seed }: NetworksState, model: Model | undefined): Caption {
  return {
    data: `network ${model?.title ?? 'unknown'}, and scenes simulated from seed ${seed}`,
    settings: `${targets} targets, SNR ${snr} dB`,
  };
}

export function update(patch: Partial<NetworksState>): void {
  networksState.value = { ...networksState.value, ...patch };
}
