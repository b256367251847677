/** Regions of interest of the 3D-CNN's paper (Sang et al. 2021), simulated with the radar that a network was trained on. */
import type { CubeOptions, RegionOfInterest } from 'boresight';
import { api } from '../../data.ts';
import type { Card } from '../../networks/models.ts';

interface Radar {
  waveform: string;
  array: string;
  /** Nearest and farthest target. */
  rangeM: readonly [number, number];
}

/** Of the paper's Table 3. */
const SIMULATED: Radar = { waveform: '3dcnn-simulated', array: 'ula8', rangeM: [70, 90] };
/** Of its Table 4. */
const EXPERIMENT: Radar = { waveform: '3dcnn-experiment', array: 'awr1642', rangeM: [9.7, 10.3] };

/** The radar of a network of regions; Table 3's where its card names none. */
export const radarOf = ({ data }: Card): Radar => (data?.waveform === EXPERIMENT.waveform ? EXPERIMENT : SIMULATED);

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

/** Equal targets that stand still, as a cube is simulated of them. The SNR is of one sample of one chirp at one element. */
export function cubeOptions(
  { array, rangeM: [nearest, farthest] }: Radar,
  targets: number,
  snrDb: number,
  seed: number,
  together: boolean,
): Omit<CubeOptions, 'waveform'> {
  const share = (seed * 0.618034) % 1;
  const rangeM = [share, (share + 0.381966) % 1].map((part) => nearest + (farthest - nearest) * part);
  return {
    array,
    snrDb,
    seed,
    targets: anglesOf(targets, seed).map((azimuthDeg, i) => ({
      azimuthDeg,
      rangeM: rangeM[together ? 0 : i] as number,
    })),
  };
}

export function simulateRegion(
  radar: Radar,
  targets: number,
  snrDb: number,
  seed: number,
  together: boolean,
): RegionScene {
  const options = cubeOptions(radar, targets, snrDb, seed, together);
  const cube = api.simulateCube({ waveform: api.waveformPreset(radar.waveform), ...options });
  const found = api.strongestRegion(cube);
  const [bins = 0, , chirps = 0] = found.region.shape;
  return { ...found, azimuthDeg: anglesOf(targets, seed), vectors: bins * chirps };
}
