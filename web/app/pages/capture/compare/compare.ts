/** What the kept settings, A, make of the capture that is open. */
import { computed, effect, signal } from '@preact/signals';
import type { ChainOptions, FrameResult } from 'boresight';
import { aborted, describeError, type Problem } from '../../../data.ts';
import type { Caption } from '../../../state/address.ts';
import { comparison } from '../../../state/comparison.ts';
import { result, shownFrame, withNetwork } from '../detections/process.ts';
import { fileNames, loaded } from '../files/files.ts';
import { runChain } from '../files/source.ts';
import { captureCodec, captureState, chainOptions, settingsOf } from '../state.ts';

/** Both are of the same files, and looked at in the same way. */
export const compared = comparison(captureCodec, captureState, {
  names: {
    frame: 'Frame',
    methods: 'Angle methods for the cell',
    networks: 'Networks',
    calibration: 'Array calibration',
  },
  but: [
    ...(['source', 'cell', 'board', 'span', 'colors', 'methods', 'networks', 'regions'] as const),
    ...(['calibrationFrames', 'calibrationModel', 'calibrationSnr', 'calibrationResidual'] as const),
    ...(['reflectors', 'exactRanges'] as const),
  ],
});

export const keptView = signal<FrameResult | null>(null);
export const keptProblem = signal<Problem | null>(null);

/** For those who see a plot alone. */
export const caption = (): Caption => ({
  data: fileNames(),
  settings: compared.captioned(result.peek()?.settings ?? settingsOf(captureState.peek())),
});

/** Runs A's chain whenever other settings are kept or another capture is open; the newest wins. */
export function start(): () => void {
  let running: AbortController | undefined;
  const chain = computed(() => {
    const a = compared.kept.value;
    const capture = loaded.value;
    return a && capture ? JSON.stringify([chainOptions(a), shownFrame(capture, a)]) : '';
  });
  const stop = effect(() => {
    const capture = loaded.value;
    const wanted = chain.value;
    running?.abort();
    const mine = new AbortController();
    running = mine;
    keptView.value = null;
    keptProblem.value = null;
    const a = compared.kept.peek();
    if (!wanted || !capture || !a) return;
    const [options, frame] = JSON.parse(wanted) as [ChainOptions, number | 'all'];
    withNetwork(options.angle ?? {}, a)
      .then((angle) => runChain(capture, { ...options, angle }, frame, { signal: mine.signal }))
      .then((view) => {
        if (running === mine) keptView.value = view;
      })
      .catch((error: unknown) => {
        if (running === mine && !aborted(error)) keptProblem.value = describeError(error);
      });
  });
  return () => {
    stop();
    running?.abort();
    running = undefined;
  };
}
