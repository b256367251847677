/** Regions of interest of the 3D-CNN's paper (Sang et al. 2021), simulated with the waveform of its Table 3. */
import type { RegionOfInterest } from 'boresight';
import { api } from '../../data.ts';

const WAVEFORM = '3dcnn-simulated';
export const REGION_ARRAY = 'ula8';

export interface RegionScene extends RegionOfInterest {
  /** Whole degrees, ascending. */
  azimuthDeg: number[];
  /** Vectors that the covariance is of. */
  vectors: number;
}

/** Pairs of whole degrees from -10 to 10, or single ones, by number: the seed walks through all of them. */
export function anglesOf(targets: number, seed: number): number[] {
  if (targets === 0) return [];
  const step = (seed * 83) % (targets === 1 ? 21 : 210);
  if (targets === 1) return [step - 10];
  const pairs = Array.from({ length: 21 }, (_, a) =>
    Array.from({ length: 20 - a }, (_, b) => [a - 10, a - 9 + b]),
  ).flat();
  return pairs[step] as number[];
}

/** Equal targets that stand still at 70 to 90 m. The SNR is of one sample of one chirp at one element. */
export function simulateRegion(targets: number, snrDb: number, seed: number, together: boolean): RegionScene {
  const azimuthDeg = anglesOf(targets, seed);
  const share = (seed * 0.618034) % 1;
  const rangeM = [70 + 20 * share, 70 + 20 * ((share + 0.381966) % 1)];
  const cube = api.simulateCube({
    waveform: api.waveformPreset(WAVEFORM),
    array: REGION_ARRAY,
    snrDb,
    seed,
    targets: azimuthDeg.map((azimuth, i) => ({ azimuthDeg: azimuth, rangeM: rangeM[together ? 0 : i] as number })),
  });
  const found = api.strongestRegion(cube);
  const [bins = 0, , chirps = 0] = found.region.shape;
  return { ...found, azimuthDeg, vectors: bins * chirps };
}
