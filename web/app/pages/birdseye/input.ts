/** What is looked at: the simulated street, or the capture that is open. */
import { computed } from '@preact/signals';
import type { ArrayInput, CubeChainOptions, Mounting, StreetOptions, StreetScene, ViewGrid, Waveform } from 'boresight';
import { api, describeError, type Problem } from '../../data.ts';
import { boardLog, type Loaded, loaded, waiting } from '../capture/files/files.ts';
import { type BirdseyeState, birdseyeState, MAX_CELLS, MAX_REACH_M, RADARS } from './state.ts';

export interface Radar {
  name: string;
  title: string;
  mounting: Mounting;
  array: ArrayInput;
  waveform: Waveform;
  fieldOfViewDeg: number;
}

export interface Point {
  xM: number;
  yM: number;
  kind?: string;
}

export interface Input {
  /** Changes with what is looked at. */
  key: string;
  radars: Radar[];
  street: StreetScene | null;
  capture: Loaded | null;
  /** How far images reach by themselves, and the width of their cells. */
  reachM: number;
  cellM: number;
}

/** A capture says nothing of a car: its radar stands at the origin and looks ahead. */
const AT_ORIGIN: Mounting = { xM: 0, yM: 0, yawDeg: 0 };
/** What a board on a bench sees. */
const CAPTURE_FIELD_DEG = 75;

/** What the street is made from. */
export const streetOptions = ({ seed, speed }: BirdseyeState): StreetOptions => ({ seed, egoSpeedMps: speed });

const streetKey = computed(() => JSON.stringify(streetOptions(birdseyeState.value)));

const street = computed<Input | Problem>(() => {
  try {
    const scene = api.streetScene(JSON.parse(streetKey.value));
    const radars = [...scene.radars].sort(
      (a, b) => RADARS.indexOf(a.name as 'front-left') - RADARS.indexOf(b.name as 'front-left'),
    );
    return {
      key: `street ${streetKey.value}`,
      street: scene,
      capture: null,
      reachM: 60,
      cellM: 0.2,
      radars: radars.map((radar) => ({ ...radar, title: sentence(radar.name.replace('-', ' ')) })),
    };
  } catch (error) {
    return describeError(error);
  }
});

let captures = 0;
const numbers = new WeakMap<Loaded, number>();

const capture = computed<Input | Problem | null>(() => {
  if (waiting.value) {
    const missing = waiting.value.missing.map(({ what }) => what).join(' and ');
    return { code: 'missing', message: `The files opened on the Capture page are not all there yet: ${missing}.` };
  }
  const open = loaded.value;
  if (!open) return null;
  const { info } = open;
  if (!info.array)
    return {
      code: 'unknown-array',
      message: 'The capture’s platform is not known, so nothing is known of its array either.',
    };
  if (!numbers.has(open)) numbers.set(open, captures++);
  const { waveform, summary, array } = info.config;
  const { tx, rx } = info.array;
  return {
    key: `capture ${numbers.get(open)}`,
    street: null,
    capture: open,
    reachM: Math.min(Math.ceil(summary.maxRangeM), MAX_REACH_M),
    cellM: 0.05,
    radars: [
      {
        name: 'capture',
        title: 'The capture’s radar',
        mounting: AT_ORIGIN,
        array: array ?? { tx, rx },
        waveform,
        fieldOfViewDeg: CAPTURE_FIELD_DEG,
      },
    ],
  };
});

const either = computed(() => (birdseyeState.value.source === 'street' ? street.value : capture.value));
export const input = computed<Input | null>(() => (either.value && 'key' in either.value ? either.value : null));
export const problemOfInput = computed<Problem | null>(() =>
  either.value && 'code' in either.value ? either.value : null,
);

/** The radars that are switched on. */
export const shownRadars = computed<readonly Radar[]>(() => {
  const { radars } = birdseyeState.value;
  return (input.value?.radars ?? []).filter(({ name }) => name === 'capture' || radars.includes(name as 'front-left'));
});

/** Objects the board reported in its last frame: the only truth there is of a capture. */
export const boardPoints = computed<Point[]>(() =>
  input.value?.capture ? (boardLog.value?.frames.at(-1)?.objects ?? []) : [],
);

export const reachM = computed(() => birdseyeState.value.reach ?? input.value?.reachM ?? 50);
export const cellM = computed(() =>
  birdseyeState.value.cell === null ? (input.value?.cellM ?? 0.2) : Number(birdseyeState.value.cell),
);

/** The grid of the images, the same for all: they are taller than wide, as a street seen by a driver. */
export const grid = computed<Required<ViewGrid>>(() => {
  const reach = reachM.value;
  return {
    xM: [-reach * (input.value?.capture ? 0.05 : 0.3), reach],
    yM: [-0.4 * reach, 0.4 * reach],
    cellM: cellM.value,
  };
});

/** Why there can be no image of this grid. */
export const gridProblem = computed<Problem | null>(() => {
  const { xM, yM, cellM: size } = grid.value;
  const cells = ((xM[1] - xM[0]) / size) * ((yM[1] - yM[0]) / size);
  if (cells <= MAX_CELLS) return null;
  return {
    code: 'too-large',
    message: `Cells of ${size} m out to ${reachM.value} m would be ${(cells / 1e6).toFixed(1)} million; at most ${MAX_CELLS / 1e6} million are expected. Choose wider cells or a shorter reach.`,
  };
});

/** What a radar's frame is processed by. */
export function chainOptions(radar: Radar, { falseAlarm, grouping }: BirdseyeState): CubeChainOptions {
  return {
    waveform: radar.waveform,
    array: radar.array,
    peakGrouping: grouping,
    maxDetections: 4096,
    // The detector of images, as `imagePlan` has it.
    cfar: { kind: 'cell-averaging', falseAlarm: Number(falseAlarm) },
  };
}

function sentence(text: string): string {
  return text.charAt(0).toUpperCase() + text.slice(1);
}
