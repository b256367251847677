import * as glue from '../../wasm/boresight.js';
import { frameCells } from '../capture/capture.js';
import { Estimator, methods } from '../estimate/estimate.js';
import { waveformSummary } from '../radar/waveform.js';
import { own, wrong } from '../runtime/errors.js';
import { call } from '../runtime/instance.js';
import type {
  AngleOptions,
  BirdsEyeView,
  BirdsEyeViewInput,
  ComplexData,
  Gate,
  ImageFrame,
  ImageFrameOptions,
  ImagePlan,
  MapGrid,
  RangeAzimuthMap,
  RangeAzimuthMapInput,
  SidelobeMeasure,
  Waveform,
} from '../types.js';
import { chainOf } from './options.js';

/** Azimuths of a map where none are asked for, and how far to each side. */
const AZIMUTHS = 512;
const FIELD_OF_VIEW_DEG = 60;

/** Adds the targets or spectra of a frame's cells to a grid: summation splatting (Niklaus and Liu 2020). */
export function rangeAzimuthMap(input: RangeAzimuthMapInput): RangeAzimuthMap {
  return call(() => glue.rangeAzimuthMap(input) as RangeAzimuthMap);
}

/** Resamples maps bilinearly onto the ground around the car; the maximum where radars overlap. */
export function birdsEyeView(input: BirdsEyeViewInput): BirdsEyeView {
  return call(() => glue.birdsEyeView(input) as BirdsEyeView);
}

/** How much of a view is not within gates round the true targets. */
export function sidelobeMeasure(
  view: BirdsEyeView,
  targets: readonly { xM: number; yM: number }[],
  gate: Gate,
): SidelobeMeasure {
  return call(() => glue.sidelobeMeasure(view, targets, gate) as SidelobeMeasure);
}

/** What options of an image mean: the estimator, what of it goes into the map, and the map's grid. */
export function imagePlan(options: ImageFrameOptions): ImagePlan {
  const given = own(options, 'options') as unknown as ImageFrameOptions;
  const { array, from } = given;
  const waveform = own(given.waveform, 'waveform') as unknown as Waveform;
  const angle = own(given.angle ?? undefined, 'angle') as AngleOptions;
  const grid = own(given.grid ?? undefined, 'grid') as Partial<MapGrid>;
  if (from != null && from !== 'spectra' && from !== 'targets') throw wrong('from', "'spectra' or 'targets'", from);
  const method = angle.method ?? 'bartlett';
  const suited = call(() => glue.suitedAngle(array, angle) as { dynamicRangeDb: number; loading: number });
  const { rangeResolutionM } = waveformSummary(waveform);
  const hasSpectrum = methods().some(({ name, spectrum }) => name === method && spectrum);
  const field = { fieldOfViewDeg: FIELD_OF_VIEW_DEG, azimuths: AZIMUTHS };
  const ranges = { rangeM: [0, (waveform.samples - 1) * rangeResolutionM] as const, ranges: waveform.samples };
  return {
    estimator: { ...angle, ...suited, method, array },
    from: from ?? (hasSpectrum ? 'spectra' : 'targets'),
    grid: { ...ranges, ...field, ...grid },
  };
}

/** From a cube of one frame to its map: cells, their estimates, splatting. */
export function imageFrame(cube: ComplexData, options: ImageFrameOptions): ImageFrame {
  const { estimator: own, from, grid } = imagePlan(options);
  const cells = frameCells(cube, chainOf(options));
  const estimator = new Estimator(own);
  try {
    const estimates = estimator.estimateBatch({ snapshots: cells.snapshots }, { spectra: from === 'spectra' });
    return { cells, estimates, map: rangeAzimuthMap({ cells, estimates, from, grid }) };
  } finally {
    estimator.free();
  }
}
