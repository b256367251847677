/** What files hold. */
import type { RealData, Warning, Waveform, WaveformSummary } from '../types.js';

/** An array of a `.npy` file: `complex` data is interleaved, integers become `Float64Array`. */
export interface NpyArray extends RealData {
  kind: 'real' | 'complex';
}

export interface RadarConfig {
  waveform: Waveform;
  summary: WaveformSummary;
  /** Number of receivers and of transmitters in use. */
  receivers: number;
  transmitters: number;
  /** Their numbers on the chip, from 0; transmitters in order of transmission. */
  receiverNumbers: number[];
  transmitterNumbers: number[];
  /** Preset that fits the platform and channels, if there is one. */
  array: string | null;
  platform: string | null;
  sdkVersion: string | null;
  sampleBits: number;
  /** Bytes of one frame of raw samples. */
  frameBytes: number;
  /** Frames to record; null until stopped. */
  frames: number | null;
  /** Lines that were not understood, and other remarks. */
  warnings: Warning[];
}

/** An object the board itself detected. */
export interface BoardObject {
  rangeM: number;
  /** Null where the packet holds a Doppler bin only and no configuration tells its width. */
  rateMps: number | null;
  azimuthDeg: number;
  elevationDeg: number;
  /** Forward, left and up. */
  xM: number;
  yM: number;
  zM: number;
  /** As sent by SDK 1 and 2. */
  rangeBin?: number;
  dopplerBin?: number;
  peak?: number;
  /** As sent by SDK 3. */
  snrDb?: number;
}

export interface BoardFrame {
  frameNumber: number;
  platform: string;
  sdkVersion: string;
  objects: BoardObject[];
  /** Range profile at zero Doppler as sent, where present. */
  rangeProfileDb?: Float64Array;
  noiseProfileDb?: Float64Array;
  /** False for a packet the end of the input cut. */
  complete: boolean;
}

/** What was lost of a board's output. */
export interface BoardLogCounts {
  /** Bytes that belong to no packet. */
  skippedBytes: number;
  /** Packets that were cut or damaged. */
  damagedPackets: number;
  warnings: Warning[];
}

export interface BoardLog extends BoardLogCounts {
  frames: BoardFrame[];
}
