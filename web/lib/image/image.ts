import * as glue from '../../wasm/boresight.js';
import { frameCells } from '../capture/capture.js';
import { Estimator } from '../estimate/estimate.js';
import { own, wrong } from '../runtime/errors.js';
import { call } from '../runtime/instance.js';
import type {
  AngleOptions,
  BirdsEyeView,
  BirdsEyeViewInput,
  CfarOptions,
  ComplexData,
  Gate,
  ImageDefaults,
  ImageFrame,
  ImageFrameOptions,
  ImagePlan,
  MapGrid,
  RangeAzimuthMap,
  RangeAzimuthMapInput,
  SidelobeMeasure,
} from '../types.js';

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

/** What options of an image mean: the chain, the estimator, what of it goes into the map, and the map's grid. */
export function imagePlan(options: ImageFrameOptions): ImagePlan {
  const { from, grid, ...chain } = own(options, 'options') as unknown as ImageFrameOptions;
  const waveform = own(chain.waveform, 'waveform');
  const angle = own(chain.angle ?? undefined, 'angle') as AngleOptions;
  const asked = own(grid ?? undefined, 'grid') as Partial<MapGrid>;
  if (from != null && from !== 'spectra' && from !== 'targets') throw wrong('from', "'spectra' or 'targets'", from);
  const usual = call(() => glue.imageDefaults(waveform, chain.array, angle) as ImageDefaults);
  const { peakGrouping, maxDetections, method, dynamicRangeDb, loading } = usual;
  const cfar = { ...usual.cfar, ...(own(chain.cfar ?? undefined, 'cfar') as Partial<CfarOptions>) };
  return {
    chain: { peakGrouping, maxDetections, ...chain, cfar },
    estimator: { ...angle, method, dynamicRangeDb, loading, array: chain.array },
    from: from ?? usual.from,
    grid: { ...usual.grid, ...asked },
  };
}

/** From a cube of one frame to its map: cells, their estimates, splatting. */
export function imageFrame(cube: ComplexData, options: ImageFrameOptions): ImageFrame {
  const { chain, estimator: chosen, from, grid } = imagePlan(options);
  const cells = frameCells(cube, chain);
  const estimator = new Estimator(chosen);
  try {
    const estimates = estimator.estimateBatch({ snapshots: cells.snapshots }, { spectra: from === 'spectra' });
    return { cells, estimates, map: rangeAzimuthMap({ cells, estimates, from, grid }) };
  } finally {
    estimator.free();
  }
}
