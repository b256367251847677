/** What a radar is: its array, its waveform, its place on the car. */

/** Antenna position in half wavelengths: x forward, y left, z up. */
export type Position = readonly [x: number, y: number, z: number];

/** A preset's name (`lrr48`, `awr1642`, `awr1843`, `cascade86`, `ula8` for any N) or positions. */
export type ArrayInput =
  | string
  | { positions: readonly Position[] }
  | { tx: readonly Position[]; rx: readonly Position[]; withoutDuplicates?: boolean };

export interface ArrayGeometry {
  positions: Position[];
  tx: Position[];
  rx: Position[];
  /** Transmitter and receiver of each element. */
  channels: { tx: number; rx: number }[];
  /** Length along y, half wavelengths. */
  aperture: number;
  extent: 'point' | 'azimuth' | 'line' | 'area';
  uniform: boolean;
  /** Half width of the sector without grating lobes; 90 when there is none. */
  unambiguousDeg: number;
  /** Where the beam at boresight has its first null: from there on two equal targets are told apart; 90 when there is none. */
  resolutionDeg: number;
}

export interface Waveform {
  startFrequencyHz: number;
  slopeHzPerS: number;
  sampleRateHz: number;
  samples: number;
  adcStartS: number;
  chirpIntervalS: number;
  transmitters: number;
  loops: number;
  frameIntervalS: number;
}

/** Numbers engineers look for first. */
export interface WaveformSummary {
  bandwidthHz: number;
  centreFrequencyHz: number;
  wavelengthM: number;
  rangeResolutionM: number;
  maxRangeM: number;
  rateResolutionMps: number;
  maxRateMps: number;
  frameTimeS: number;
}

/** Where a radar sits in the car's frame (origin at the rear axle, x forward, y left) and which way it looks. */
export interface Mounting {
  xM: number;
  yM: number;
  /** Direction of boresight, counter-clockwise from the car's x. */
  yawDeg: number;
}
