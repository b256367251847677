/**
 * Regions of interest of the 3D-CNN's paper, simulated: a cube's range spectrum cut to the bins around the strongest.
 */
import type { ComplexData, Waveform } from 'boresight';
import { api } from '../../data.ts';

/** Table 3 of Sang et al. (2021): 150 MHz in 256 samples, so range bins of 1 m. The paper names no chirp interval. */
export const WAVEFORM: Waveform = {
  startFrequencyHz: 77e9,
  slopeHzPerS: 3.476e12,
  sampleRateHz: (256 * 3.476e12) / 0.15e9,
  samples: 256,
  adcStartS: 0,
  chirpIntervalS: 50e-6,
  transmitters: 1,
  loops: 4,
  frameIntervalS: 40e-3,
};
export const REGION_ARRAY = 'ula8';
const [BINS, ELEMENTS, CHIRPS] = [65, 8, 4];

export interface RegionScene {
  /** Whole degrees, ascending. */
  azimuthDeg: number[];
  /** Bins x elements x chirps. */
  region: ComplexData;
  covariance: ComplexData;
  /** Vectors that the covariance is of. */
  vectors: number;
  /** The strongest bin: elements x chirps. */
  snapshots: ComplexData;
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
    waveform: WAVEFORM,
    array: REGION_ARRAY,
    snrDb,
    seed,
    targets: azimuthDeg.map((azimuth, i) => ({ azimuthDeg: azimuth, rangeM: rangeM[together ? 0 : i] as number })),
  });
  return { azimuthDeg, ...cut(cube.data) };
}

/** `cube`: loops x elements x samples. */
function cut(cube: Float32Array): Omit<RegionScene, 'azimuthDeg'> {
  const { samples } = WAVEFORM;
  const spectrum = new Float64Array(2 * CHIRPS * ELEMENTS * samples);
  const power = new Float64Array(samples);
  const turn = Array.from(
    { length: samples },
    (_, i) => [Math.cos((2 * Math.PI * i) / samples), Math.sin((2 * Math.PI * i) / samples)] as const,
  );
  for (let row = 0; row < CHIRPS * ELEMENTS; row++) {
    for (let bin = 0; bin < samples; bin++) {
      let [re, im] = [0, 0];
      for (let n = 0; n < samples; n++) {
        const [cosine, sine] = turn[(bin * n) % samples] as readonly [number, number];
        const [x, y] = [cube[2 * (row * samples + n)] as number, cube[2 * (row * samples + n) + 1] as number];
        re += x * cosine + y * sine;
        im += y * cosine - x * sine;
      }
      const at = 2 * (row * samples + bin);
      spectrum[at] = re / samples;
      spectrum[at + 1] = im / samples;
      power[bin] = (power[bin] as number) + (re * re + im * im);
    }
  }
  const strongest = power.indexOf(Math.max(...power));
  const region = new Float32Array(2 * BINS * ELEMENTS * CHIRPS);
  const first = strongest + samples - Math.floor(BINS / 2);
  for (let bin = 0; bin < BINS; bin++) {
    for (let element = 0; element < ELEMENTS; element++) {
      for (let chirp = 0; chirp < CHIRPS; chirp++) {
        const from = 2 * ((chirp * ELEMENTS + element) * samples + ((first + bin) % samples));
        region.set(spectrum.subarray(from, from + 2), 2 * ((bin * ELEMENTS + element) * CHIRPS + chirp));
      }
    }
  }
  const middle = Math.floor(BINS / 2) * ELEMENTS * CHIRPS;
  return {
    region: { data: region, shape: [BINS, ELEMENTS, CHIRPS] },
    covariance: { data: covarianceOf(region), shape: [ELEMENTS, ELEMENTS] },
    vectors: BINS * CHIRPS,
    snapshots: {
      data: Float64Array.from(region.subarray(2 * middle, 2 * (middle + ELEMENTS * CHIRPS))),
      shape: [ELEMENTS, CHIRPS],
    },
  };
}

/** The mean over chirps of the sum over bins of each vector times its conjugate. */
function covarianceOf(region: Float32Array): Float64Array {
  const out = new Float64Array(2 * ELEMENTS * ELEMENTS);
  for (let bin = 0; bin < BINS; bin++) {
    for (let chirp = 0; chirp < CHIRPS; chirp++) {
      const at = (element: number): number => 2 * ((bin * ELEMENTS + element) * CHIRPS + chirp);
      for (let i = 0; i < ELEMENTS; i++) {
        const [a, b] = [region[at(i)] as number, region[at(i) + 1] as number];
        for (let k = 0; k < ELEMENTS; k++) {
          const [c, d] = [region[at(k)] as number, region[at(k) + 1] as number];
          const to = 2 * (i * ELEMENTS + k);
          out[to] = (out[to] as number) + (a * c + b * d) / CHIRPS;
          out[to + 1] = (out[to + 1] as number) + (b * c - a * d) / CHIRPS;
        }
      }
    }
  }
  return out;
}

/** What networks on a covariance take: its upper triangle by rows, over its largest diagonal entry. */
export function covarianceFeatures({ data }: ComplexData): number[] {
  let largest = 0;
  for (let i = 0; i < ELEMENTS; i++) largest = Math.max(largest, data[2 * (i * ELEMENTS + i)] as number);
  const out: number[] = [];
  for (let i = 0; i < ELEMENTS; i++) {
    for (let k = i + 1; k < ELEMENTS; k++) {
      const at = 2 * (i * ELEMENTS + k);
      out.push((data[at] as number) / largest, (data[at + 1] as number) / largest);
    }
  }
  return out;
}

/** What the 3D-CNN takes of a region: magnitude, real and imaginary part. */
export function regionChannels({ data }: ComplexData): number[] {
  const out: number[] = [];
  for (let i = 0; i < data.length; i += 2) {
    const [re, im] = [data[i] as number, data[i + 1] as number];
    out.push(Math.hypot(re, im), re, im);
  }
  return out;
}
