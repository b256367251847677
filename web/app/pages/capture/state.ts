/** State of the capture page: all of it in the address but the files themselves. */
import { signal } from '@preact/signals';
import type {
  AngleOptions,
  ArrayCalibrationOptions,
  CaptureRegionOptions,
  Cell,
  ChainOptions,
  Method,
  ReadingOptions,
} from 'boresight';
import { COLOR_MAPS } from '../../../plots/colormap.ts';
import { methodNames, networkNames } from '../../methods.ts';
import { optionsOf } from '../../options.ts';
import { choice, codec, type Field, flag, names, number, text } from '../../state/codec.ts';
import { keptField } from '../../state/comparison.ts';
import { COLOURED_BY } from '../../ui/space/points.ts';
import { PRESETS } from '../angle/state.ts';
import { idOf, ownOf } from './array-calibration/own-calibrations.ts';

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

/** A reflector to calibrate by; without an azimuth its direction is not known. */
export interface KnownReflector {
  rangeM: number;
  azimuthDeg: number | null;
  elevationDeg: number;
}

const NUMBER = String.raw`-?\d{1,7}(?:\.\d{1,12})?`;
const REFLECTOR = new RegExp(`^(${NUMBER}):(${NUMBER})?:(${NUMBER})$`);
export const MOST_REFLECTORS = 64;

/** `range:azimuth:elevation` of each. */
const reflectors: Field<readonly KnownReflector[]> = {
  fallback: [],
  read: (value) => {
    if (value === '') return [];
    const all = value.split(',').map((one): KnownReflector | null => {
      const [, range, azimuth, elevation] = REFLECTOR.exec(one) ?? [];
      if (range === undefined) return null;
      const made = {
        rangeM: Number(range),
        azimuthDeg: azimuth === undefined ? null : Number(azimuth),
        elevationDeg: Number(elevation),
      };
      return made.rangeM >= 0 && Math.abs(made.azimuthDeg ?? 0) <= 90 && Math.abs(made.elevationDeg) <= 90
        ? made
        : null;
    });
    return all.length <= MOST_REFLECTORS && all.every((one) => one !== null) ? all : undefined;
  },
  write: (all) => all.map((one) => [one.rangeM, one.azimuthDeg ?? '', one.elevationDeg].join(':')).join(','),
};

const detection = optionsOf('DetectionOptions');
const reading = optionsOf('ReadingOptions');
const region = optionsOf('RegionChainOptions');
const arrayCalibration = optionsOf('ArrayCalibrationOptions');

export const captureCodec = codec(
  {
    source: choice('bundled', ['bundled', 'simulated', 'files']),
    frame,
    cell,
    iqOrder: reading.field('iqOrder'),
    lanes: reading.field('lanes'),
    /** Of an advanced frame. */
    subFrame: choice('0', ['0', '1', '2', '3']),
    array: choice('auto', ['auto', ...PRESETS]),
    /** Of one's own calibrations the id. */
    calibration: text('configured', (value) => ['configured', 'none'].includes(value) || idOf(value) !== null),
    window: detection.field('rangeWindow'),
    dopplerWindow: detection.field('dopplerWindow'),
    rangePadding: detection.picks('rangePadding', ['1', '2', '4']),
    dopplerPadding: detection.picks('dopplerPadding', ['1', '2', '4', '8']),
    clutter: detection.field('staticClutterRemoval'),
    cfar: detection.field('cfar.kind'),
    axes: detection.field('cfar.axes'),
    falseAlarm: detection.picks('cfar.falseAlarm', ['1e-2', '1e-3', '1e-4', '1e-5', '1e-6', '1e-7', '1e-8']),
    // Wider windows find no room in a frame, and none finds no noise.
    guardRange: detection.field('cfar.guardCells.0', { max: 32 }),
    guardDoppler: detection.field('cfar.guardCells.1', { max: 32 }),
    trainRange: detection.field('cfar.trainingCells.0', { min: 1, max: 64 }),
    trainDoppler: detection.field('cfar.trainingCells.1', { min: 1, max: 64 }),
    rank: detection.field('cfar.rank'),
    grouping: detection.field('peakGrouping'),
    folds: detection.field('dopplerFolds'),
    // 0 for no limit: the package then has its own, or none where only the other is given.
    nearest: detection.field('region.rangeM.0', { fallback: 0, min: 0, max: 10_000 }),
    farthest: detection.field('region.rangeM.1', { fallback: 0, min: 0, max: 10_000 }),
    /** Half of it, to both sides. */
    sector: detection.field('region.azimuthDeg.1', { fallback: 90, min: 1 }),
    /** The same upwards and downwards. */
    elevation: detection.field('region.elevationDeg.1', { fallback: 90, min: 1 }),
    angle: detection.field('angle.method'),
    methods: names<Method>(['bartlett', 'capon', 'iaa'], methodNames),
    sources: detection.picks('angle.sources', ['auto', 'mdl', 'aic', '1', '2', '3', '4']),
    networks: networkNames,
    refine: detection.field('angle.refine'),
    mismatch: detection.maybe('angle.mismatchDb'),
    /** Whether regions are found, and their networks loaded. */
    regions: flag(false),
    regionsBy: choice('cnn3d', ['cnn3d', 'dnn']),
    // Targets of a recording have sidelobes in range, which networks never saw, and its board differs from those of the
    // training: a window, one bin a region and a loaded covariance keep both from being counted.
    regionWindow: region.field('regionWindow', { fallback: 'hann' }),
    regionReach: number(0, [0, 32], 'integer'),
    countLoading: region.field('countLoading', { fallback: 1, max: 1000 }),
    rotation: region.field('rotation'),
    regionRefine: region.field('refine'),
    /** To both sides of the chosen cell's range, m. */
    gate: number(0.25, [0, 1000]),
    /** Which frames a calibration is made from; the others check it. */
    calibrationFrames: choice('even', ['even', 'half', 'all']),
    calibrationModel: arrayCalibration.field('model'),
    calibrationSnr: arrayCalibration.field('minSnrDb'),
    calibrationResidual: arrayCalibration.field('maxResidualDb'),
    reflectors,
    exactRanges: arrayCalibration.field('rangeBias'),
    span: choice('60', ['30', '40', '50', '60', '80']),
    colors: choice('viridis', COLOR_MAPS),
    /** Detections from above, or in space. */
    points: choice('above', ['above', 'space']),
    pointColour: choice('rate', COLOURED_BY),
    board: text('last', (value) => value === 'last' || /^\d{1,7}$/.test(value)),
    a: keptField,
  },
  ['frame', 'methods'],
);

export type CaptureState = typeof captureCodec.defaults;
export const captureState = signal<CaptureState>(captureCodec.defaults);

export function update(patch: Partial<CaptureState>): void {
  captureState.value = { ...captureState.value, ...patch };
}

/** How the samples are read. */
export const readingOptions = ({ iqOrder, lanes }: CaptureState): ReadingOptions => ({ iqOrder, lanes });

/** For those who see a plot alone. */
export function settingsOf(state: CaptureState): string {
  const { frame, window, dopplerWindow, cfar, falseAlarm, clutter, angle, calibration } = state;
  return [
    frame === 'all' ? 'all frames' : `frame ${frame + 1}`,
    `windows ${window} and ${dopplerWindow}`,
    `CFAR ${cfar}, false alarms ${falseAlarm}`,
    ...(clutter ? ['static clutter removed'] : []),
    `angles by ${angle}`,
    ...(calibration === 'configured' ? [] : [`array calibration ${ownOf(calibration)?.name ?? calibration}`]),
  ].join(', ');
}

/** The part of the state that detection depends on, as the package takes it. */
export function chainOptions(state: CaptureState): ChainOptions {
  const { nearest, farthest, sector, elevation } = state;
  const regionSet = nearest > 0 || farthest > 0 || sector < 90 || elevation < 90;
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
    dopplerFolds: state.folds,
    ...(regionSet
      ? {
          region: {
            ...(nearest > 0 || farthest > 0 ? { rangeM: [nearest, farthest || 1e6] as const } : {}),
            ...(sector < 90 ? { azimuthDeg: [-sector, sector] as const } : {}),
            ...(elevation < 90 ? { elevationDeg: [-elevation, elevation] as const } : {}),
          },
        }
      : {}),
    angle: { method: state.angle, ...(state.mismatch === null ? {} : { mismatchDb: state.mismatch }) },
    ...calibrationOption(state),
  };
}

/** One's own calibration that is not here is left to the configuration. */
function calibrationOption({ calibration }: CaptureState): Pick<ChainOptions, 'calibration'> {
  if (calibration === 'none') return { calibration };
  const own = ownOf(calibration);
  return own ? { calibration: own.value } : {};
}

/** How the array is calibrated, the frames apart. */
export function calibrationOptions(state: CaptureState, by: 'reflectors' | 'cells'): ArrayCalibrationOptions {
  return {
    model: state.calibrationModel,
    minSnrDb: state.calibrationSnr,
    maxResidualDb: state.calibrationResidual,
    ...(by === 'reflectors'
      ? {
          reflectors: state.reflectors.map(({ azimuthDeg, ...rest }) => ({
            ...rest,
            ...(azimuthDeg === null ? {} : { azimuthDeg }),
          })),
          rangeBias: state.exactRanges,
        }
      : {}),
  };
}

export function sourceOption({ sources }: CaptureState): number | 'auto' | 'aic' | 'mdl' {
  return sources === 'auto' || sources === 'aic' || sources === 'mdl' ? sources : Number(sources);
}

/** What the angles of a cell are estimated by beside the method. */
export const cellAngle = (state: CaptureState): AngleOptions => ({
  sources: sourceOption(state),
  ...(state.refine ? { refine: state.refine } : {}),
  ...(state.mismatch === null ? {} : { mismatchDb: state.mismatch }),
});

/** How regions are found and their targets told apart. */
export function regionOptions(state: CaptureState): CaptureRegionOptions {
  const { array, nearest, farthest } = state;
  return {
    ...(array === 'auto' ? {} : { array }),
    ...calibrationOption(state),
    regionWindow: state.regionWindow,
    reachBins: state.regionReach,
    countLoading: state.countLoading,
    rotation: state.rotation,
    refine: state.regionRefine,
    cfar: { falseAlarm: Number(state.falseAlarm) },
    ...(nearest > 0 || farthest > 0 ? { region: { rangeM: [nearest, farthest || 1e6] } } : {}),
  };
}
