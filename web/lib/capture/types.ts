/** From frames to detections: the chain, captures and what a board reports. */
import type { ArrayGeometry, ArrayInput, DetectionOptions, Warning, Waveform, WaveformSummary } from '../types.js';

/** Options of the chain from frames to detections. */
export interface ChainOptions extends DetectionOptions {
  /** Default: the preset whose virtual elements match the capture. */
  array?: ArrayInput;
}

export interface CombineOptions extends ChainOptions {
  /** Default 0. */
  firstFrame?: number;
  /** Default all that are left. */
  frameCount?: number;
}

/** Options of the chain over a cube, of which nothing else is known. */
export interface CubeChainOptions extends ChainOptions {
  waveform: Waveform;
  array: ArrayInput;
}

/** A cell of the range-Doppler map. */
export interface Cell {
  rangeBin: number;
  dopplerBin: number;
  /** One frame, for one snapshot; else one snapshot of each frame. */
  frame?: number;
}

export interface Detection {
  frame: number;
  rangeM: number;
  rateMps: number;
  azimuthDeg: number;
  elevationDeg: number;
  /** Power at one element, dB relative to full scale (1.0). */
  powerDb: number;
  /** Over the local noise estimate. */
  snrDb: number;
  rangeBin: number;
  dopplerBin: number;
}

/** What became of cells and samples. */
export interface FrameCounts {
  cellsOverThreshold: number;
  /** Of these, cells grouped under a stronger neighbour. */
  grouped: number;
  outsideRegion: number;
  beyondLimit: number;
  /** Cells in which the method found no angle. */
  withoutAngle: number;
  /** Samples at an end of the converter's range. */
  clippedSamples: number;
}

export interface FrameResult {
  /** The first one where frames were combined. */
  frame: number;
  /** Frames that went in. */
  frames: number;
  rangeM: Float64Array;
  rateMps: Float64Array;
  /** Mean over channels, Doppler summed, dB. */
  rangeProfileDb: Float64Array;
  /** range x Doppler, dB, mean over channels. */
  rangeDopplerDb: Float32Array;
  shape: [range: number, doppler: number];
  detections: Detection[];
  counts: FrameCounts;
  warnings: Warning[];
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

export interface CaptureInfo {
  config: RadarConfig;
  frames: number;
  /** Bytes after the last whole frame. */
  trailingBytes: number;
  /** Virtual array of the configured channels; null for a platform that is not known. */
  array: ArrayGeometry | null;
  warnings: Warning[];
}

/** A capture as a pool is given it. */
export interface CaptureFile {
  /** The `.bin`. */
  bytes: Uint8Array | ArrayBuffer;
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
