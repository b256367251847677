/** State of the capture page: all of it in the address but the files themselves. */
import { signal } from '@preact/signals';
import type { Cell, CfarKind, ChainOptions, Method, WindowName } from 'boresight';
import { methodNames, networkNames } from '../../methods.ts';
import { COLOR_MAPS } from '../../plots/colormap.ts';
import { choice, codec, type Field, flag, names, number, text } from '../../state/codec.ts';
import { PRESETS } from '../angle/state.ts';

export const WINDOWS: readonly WindowName[] = [
  'rectangular',
  'hann',
  'hamming',
  'blackman',
  'blackman-harris',
  'chebyshev',
  'taylor',
];
export const CFARS: readonly CfarKind[] = ['cell-averaging', 'greatest-of', 'smallest-of', 'ordered-statistic'];

export const FALSE_ALARMS = ['1e-2', '1e-3', '1e-4', '1e-5', '1e-6', '1e-7', '1e-8'] as const;

/** `all`, or a frame's number. */
const frame: Field<number | 'all'> = {
  fallback: 'all',
  read: (value) => {
    if (value === 'all') return 'all';
    return /^\d{1,6}$/.test(value) ? Number(value) : undefined;
  },
  write: String,
};

/** `range:doppler` bins; empty for the strongest detection's. */
const cell: Field<Cell | null> = {
  fallback: null,
  read: (value) => {
    const match = /^(\d{1,6}):(\d{1,6})$/.exec(value);
    return match ? { rangeBin: Number(match[1]), dopplerBin: Number(match[2]) } : undefined;
  },
  write: (value) => (value ? `${value.rangeBin}:${value.dopplerBin}` : ''),
};

export const captureCodec = codec(
  {
    frame,
    cell,
    array: choice('auto', ['auto', ...PRESETS]),
    window: choice<WindowName>('hann', WINDOWS),
    dopplerWindow: choice<WindowName>('hann', WINDOWS),
    rangePadding: choice('1', ['1', '2', '4']),
    dopplerPadding: choice('1', ['1', '2', '4', '8']),
    clutter: flag(false),
    cfar: choice<CfarKind>('cell-averaging', CFARS),
    axes: choice('range', ['range', 'doppler', 'both']),
    falseAlarm: choice('1e-6', FALSE_ALARMS),
    guardRange: number(4, [0, 32], 'integer'),
    guardDoppler: number(2, [0, 32], 'integer'),
    trainRange: number(8, [1, 64], 'integer'),
    trainDoppler: number(4, [1, 64], 'integer'),
    rank: number(0.75, [0.05, 1]),
    grouping: flag(true),
    nearest: number(0, [0, 10_000]),
    farthest: number(0, [0, 10_000]),
    sector: number(90, [1, 90]),
    angle: choice<Method>('bartlett', methodNames),
    methods: names<Method>(['bartlett', 'capon', 'iaa'], methodNames),
    sources: choice('mdl', ['mdl', 'aic', '1', '2', '3', '4']),
    networks: networkNames,
    refine: flag(false),
    span: choice('60', ['30', '40', '50', '60', '80']),
    colors: choice('viridis', COLOR_MAPS),
    board: text('last', (value) => value === 'last' || /^\d{1,7}$/.test(value)),
  },
  ['frame', 'methods'],
);

export type CaptureState = typeof captureCodec.defaults;
export const captureState = signal<CaptureState>(captureCodec.defaults);

export function update(patch: Partial<CaptureState>): void {
  captureState.value = { ...captureState.value, ...patch };
}

/** The part of the state that detection depends on, as the package takes it. */
export function chainOptions(state: CaptureState): ChainOptions {
  const regionSet = state.nearest > 0 || state.farthest > 0 || state.sector < 90;
  return {
    ...(state.array === 'auto' ? {} : { array: state.array }),
    rangeWindow: state.window,
    dopplerWindow: state.dopplerWindow,
    rangePadding: Number(state.rangePadding),
    dopplerPadding: Number(state.dopplerPadding),
    staticClutterRemoval: state.clutter,
    cfar: {
      kind: state.cfar,
      axes: state.axes,
      falseAlarm: Number(state.falseAlarm),
      guardCells: [state.guardRange, state.guardDoppler],
      trainingCells: [state.trainRange, state.trainDoppler],
      ...(state.cfar === 'ordered-statistic' ? { rank: state.rank } : {}),
    },
    peakGrouping: state.grouping,
    ...(regionSet
      ? {
          region: {
            ...(state.nearest > 0 || state.farthest > 0
              ? { rangeM: [state.nearest, state.farthest || 1e6] as const }
              : {}),
            ...(state.sector < 90 ? { azimuthDeg: [-state.sector, state.sector] as const } : {}),
          },
        }
      : {}),
    angle: { method: state.angle },
  };
}

export function sourceOption(state: CaptureState): number | 'aic' | 'mdl' {
  return state.sources === 'aic' || state.sources === 'mdl' ? state.sources : Number(state.sources);
}
