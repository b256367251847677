/** From frames to detections: captures and the chain. */
import type {
  ArrayGeometry,
  ArrayInput,
  ComplexData,
  DetectionOptions,
  RadarConfig,
  Warning,
  Waveform,
} from '../types.js';

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

/** Detected cells of a frame, strongest first, with what estimators take. */
export interface FrameCells {
  /** Of each cell; interpolated between bins. */
  rangeM: Float64Array;
  rateMps: Float64Array;
  /** Power at one element, dB relative to full scale (1.0). */
  powerDb: Float64Array;
  /** Over the local noise estimate. */
  snrDb: Float64Array;
  rangeBin: Uint32Array;
  dopplerBin: Uint32Array;
  /** cells x elements; the Doppler phase of the transmitters' turns taken off. */
  snapshots: ComplexData;
  counts: FrameCounts;
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
