/** Makes the data of the element that is shown, again when its options change; the latest wins. */
import { computed, effect, signal } from '@preact/signals';
import cfgAddress from '../../../../recordings/awr1642/profile.cfg?url';
import binAddress from '../../../../recordings/awr1642/xwr16xx_crw_dca_module_2018_1015v2.bin?url';
import datAddress from '../../../../recordings/awr1642/xwr16xx_crw_demo_visualizer_2018_1015v2.dat?url';
import { aborted, describeError, type Problem, pool } from '../../data.ts';
import { nested } from '../../schema-fields.ts';
import { bundledDrive, fetched } from '../mounting/drive/drive.ts';
import { resolved, type Sample } from './sample.ts';
import { elementsState, sample } from './state.ts';

const capture = [
  ['xwr16xx_crw_dca_module_2018_1015v2.bin', binAddress],
  ['profile.cfg', cfgAddress],
] as const;

const board = [
  ['xwr16xx_crw_demo_visualizer_2018_1015v2.dat', datAddress],
  ['profile.cfg', cfgAddress],
] as const;

type Addresses = readonly (readonly [name: string, address: string])[];
const all = (files: Addresses) => (signal: AbortSignal) =>
  Promise.all(files.map(async ([name, address]) => ({ name, bytes: await fetched(name, address, signal) })));

/** Bundled recordings that elements with files are shown with, as the demo has them. */
const RECORDINGS = {
  capture: all(capture),
  board: all(board),
  drive: bundledDrive,
};

export interface Made {
  sample: Sample;
  properties: Readonly<Record<string, unknown>>;
}

export const made = signal<Made | null>(null);
export const problem = signal<Problem | null>(null);
export const working = signal(false);

/** The options of the data that are not as by default, as the package takes them. */
export const options = computed(() =>
  nested(
    new Map([
      ...Object.entries(sample.value.usual ?? {}),
      ...[...elementsState.value.set].filter(([path]) => !path.startsWith('@')),
    ]),
  ),
);

/** The settings of the element that are not as usual. */
export const settings = computed((): Readonly<Record<string, string>> => {
  const own = [...elementsState.value.set].filter(([path]) => path.startsWith('@'));
  return {
    ...sample.value.settings,
    ...Object.fromEntries(own.map(([path, value]) => [path.slice(1), value === true ? '' : String(value)])),
  };
});

/** The properties of the element, by calls of the pool one after the other. */
async function make(shown: Sample, given: Record<string, unknown>, signal: AbortSignal): Promise<Made> {
  const values: Record<string, unknown> = {};
  if (shown.recording) values.files = await RECORDINGS[shown.recording.of](signal);
  for (const { name, call, args } of shown.steps(given)) {
    const work = pool()[call] as (...args: unknown[]) => Promise<unknown>;
    values[name] = await work.apply(pool(), resolved(args, values) as unknown[]);
    signal.throwIfAborted();
  }
  return { sample: shown, properties: resolved(shown.properties(given), values) as Made['properties'] };
}

export function start(): () => void {
  let controller: AbortController | undefined;
  let timer: ReturnType<typeof setTimeout> | undefined;
  const text = computed(() => JSON.stringify(options.value));
  const stop = effect(() => {
    const shown = sample.value;
    const given = JSON.parse(text.value) as Record<string, unknown>;
    clearTimeout(timer);
    controller?.abort();
    const mine = new AbortController();
    controller = mine;
    working.value = true;
    // Numbers are typed digit by digit.
    const pause = made.peek()?.sample === shown ? 250 : 0;
    timer = setTimeout(async () => {
      try {
        const next = await make(shown, given, mine.signal);
        made.value = next;
        problem.value = null;
      } catch (error) {
        if (mine.signal.aborted || aborted(error)) return;
        problem.value = describeError(error);
      }
      if (controller === mine) working.value = false;
    }, pause);
  });
  return () => {
    clearTimeout(timer);
    controller?.abort();
    stop();
  };
}
