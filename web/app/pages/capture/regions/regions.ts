/**
 * Regions of the shown frame by networks: what Figure 4 of Sang et al. (2021) does, beside the detections of the chain.
 */
import { batch, computed, effect, signal } from '@preact/signals';
import type { CaptureRegionOptions, RegionFrame } from 'boresight';
import { aborted, describeError, type Problem } from '../../../data.ts';
import { fitting } from '../../../networks/choose.ts';
import { load, models, readyNetworks } from '../../../networks/load.ts';
import { arrayProblem, type Model, targetsOf, trainedOnBoards } from '../../../networks/models.ts';
import { usedArray } from '../detections/process.ts';
import { type Loaded, loaded } from '../files/files.ts';
import { frameAt } from '../frames/playback.ts';
import { captureState, regionOptions } from '../state.ts';

export interface ShownRegions {
  capture: Loaded;
  frame: number;
  view: RegionFrame;
}

/** The three networks of regions. */
export type Trio = Readonly<Record<'counting' | 'one' | 'two', Model>>;

export const regions = signal<ShownRegions | null>(null);
export const regionsWorking = signal(false);
export const regionsProblem = signal<Problem | null>(null);

/** Of some networks, best first, the one for recordings, whose boards are hardly ever calibrated. */
const forRecordings = (networks: readonly Model[]): Model | undefined =>
  networks.find(({ card }) => trainedOnBoards(card)) ?? networks[0];

/** The networks that count and tell the targets of this capture's array, or why there are none. */
export const trio = computed<Trio | string | null>(() => {
  const geometry = usedArray.value;
  if (!geometry) return null;
  const { regionsBy } = captureState.value;
  const counting = forRecordings(fitting('counting', [geometry], null));
  const [one, two] = [1, 2].map((targets) =>
    forRecordings(fitting(regionsBy, [geometry], targets).filter(({ card }) => targetsOf(card) === targets)),
  );
  if (counting && one && two) return { counting, one, two };
  const any = models.value.find(({ card }) => card.network === 'counting');
  return (any && arrayProblem(any.card, geometry)) ?? 'has no networks for this array';
});

/** As text, so that effects run when they change. */
const options = computed(() => JSON.stringify(regionOptions(captureState.value)));

let running: AbortController | undefined;

export function cancelRegions(): void {
  running?.abort();
}

export function startRegions(): () => void {
  // Of all frames the first: networks take one at a time.
  const frame = computed(frameAt);
  const wanted = computed(() => captureState.value.regions);
  const stop = effect(() => {
    void readyNetworks.value;
    const capture = loaded.value;
    const networks = trio.value;
    const [chosen, at] = [options.value, frame.value];
    running?.abort();
    running = undefined;
    if (!wanted.value || !capture || !networks || typeof networks === 'string') {
      batch(() => {
        regions.value = null;
        regionsProblem.value = null;
        regionsWorking.value = false;
      });
      return;
    }
    const controller = new AbortController();
    running = controller;
    queueMicrotask(() => void find(capture, networks, at, JSON.parse(chosen) as CaptureRegionOptions, controller));
  });
  return () => {
    running?.abort();
    stop();
  };
}

async function find(
  capture: Loaded,
  networks: Trio,
  frame: number,
  options: CaptureRegionOptions,
  controller: AbortController,
): Promise<void> {
  const { signal } = controller;
  batch(() => {
    if (regions.peek()?.capture !== capture) regions.value = null;
    regionsWorking.value = true;
    regionsProblem.value = null;
  });
  try {
    const infos = await Promise.all(
      [networks.counting, networks.one, networks.two].map(({ name }) => load(name, signal)),
    );
    const [counting = '', one = '', two = ''] = infos.map(({ id }) => id);
    const view = await capture.kept.frameRegions({ counting, one, two }, frame, options, { signal });
    if (running === controller) regions.value = { capture, frame, view };
  } catch (error) {
    if (running === controller && !aborted(error))
      batch(() => {
        regions.value = null;
        regionsProblem.value = describeError(error);
      });
  } finally {
    if (running === controller) regionsWorking.value = false;
  }
}
