/** State of the bird's-eye page: all of it in the address. */
import { signal } from '@preact/signals';
import type { Method } from 'boresight';
import { COLOR_MAPS } from '../../../plots/colormap.ts';
import type { View } from '../../../plots/plot.ts';
import { networkNames, singleSnapshotMethods } from '../../methods.ts';
import { optionsOf } from '../../options.ts';
import type { Caption } from '../../state/address.ts';
import { choice, codec, type Field, flag, names, number, optional } from '../../state/codec.ts';
import { seed } from '../../state/seed.ts';

/** Names of the street's radars. */
export const RADARS = ['left', 'front-left', 'front-right', 'right'] as const;
export type RadarName = (typeof RADARS)[number];

export const MAX_REACH_M = 300;
/** Cells of an image that a page can hold for several methods. */
export const MAX_CELLS = 4_000_000;

const place: Field<View> = {
  fallback: { x: [0, 1], y: [0, 1] },
  read: (value) => {
    const [a, b, c, d, ...more] = value.split(':').map((part) => (part.trim() === '' ? Number.NaN : Number(part)));
    const far = (m: number | undefined): m is number => m !== undefined && Math.abs(m) <= 1000;
    return far(a) && far(b) && far(c) && far(d) && a < b && c < d && !more.length
      ? { x: [a, b], y: [c, d] }
      : undefined;
  },
  write: ({ x, y }) => [...x, ...y].map((value) => Number(value.toFixed(2))).join(':'),
};

const street = optionsOf('StreetOptions');
const detection = optionsOf('DetectionOptions');
const estimator = optionsOf('SharedEstimatorOptions');

export const birdseyeCodec = codec(
  {
    source: choice('street', ['street', 'capture']),
    seed,
    speed: street.field('egoSpeedMps'),
    radars: names<RadarName>(RADARS, RADARS),
    frame: number(0, [0, 9_999_999], 'integer'),
    methods: names<Method>(['bartlett', 'iaa', 'nomp'], () => singleSnapshotMethods().map(({ name }) => name)),
    networks: networkNames,
    refine: estimator.field('refine'),
    from: choice('spectra', ['spectra', 'targets']),
    falseAlarm: detection.picks('cfar.falseAlarm', ['1e-3', '1e-4', '1e-5', '1e-6', '1e-8']),
    /** Images are of all cells that are detected, not of their peaks. */
    grouping: detection.field('peakGrouping', { fallback: false }),
    /** Directions in a cell, for methods that must be told. */
    sources: estimator.picks('sources', ['1', '2', '3', '4'], '2'),
    points: estimator.picks('gridPoints', ['256', '512', '1024', '2048']),
    /** How far the images reach, m; null for what suits the input. */
    reach: optional(number(0, [2, MAX_REACH_M])),
    /** Null for what suits the input. */
    cell: optional(choice('0.2', ['0.05', '0.1', '0.2', '0.25', '0.5', '1'])),
    /** Radius of what counts as a target, m; null for what the radars resolve. */
    gate: optional(number(1, [0.05, 20])),
    span: choice('60', ['20', '30', '40', '50', '60', '80']),
    /** Power of the last colour, dB; null for the strongest cell's. */
    top: optional(number(0, [-200, 100])),
    colors: choice('viridis', COLOR_MAPS),
    /** Percent. */
    opacity: number(90, [0, 100]),
    truth: flag(true),
    fields: flag(true),
    view: optional(place),
  },
  ['source', 'seed', 'methods'],
);

export type BirdseyeState = Omit<typeof birdseyeCodec.defaults, 'view'>;
const { view: _, ...defaults } = birdseyeCodec.defaults;
export const birdseyeState = signal<BirdseyeState>(defaults);
/** Where all images are zoomed to. It changes with every move of a drag, so it stands apart. */
export const zoom = signal<View | null>(null);

/** For those who see an image alone. */
export function captionOf(state: BirdseyeState, radars: readonly { title: string }[], file: string): Caption {
  const { source, seed, frame, speed } = state;
  const street = source === 'street';
  const seen = radars.map(({ title }) => title.toLowerCase()).join(', ') || 'none';
  return {
    data: street ? `simulated street, seed ${seed}` : file,
    settings: `${street ? `own speed ${speed} m/s` : `frame ${frame + 1}`}, radars: ${seen}, from ${state.from}`,
  };
}

export function restoreDefaults(): void {
  birdseyeState.value = { ...defaults, source: birdseyeState.value.source };
  zoom.value = null;
}

export function update(patch: Partial<BirdseyeState>): void {
  birdseyeState.value = { ...birdseyeState.value, ...patch };
}
