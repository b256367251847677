/** From frames to detections: captures and the chain. */
import type {
  ArrayCalibrationInput,
  ArrayInput,
  DetectionOptions,
  ReadingOptions,
  TextInput,
  Waveform,
} from '../types.js';

/** A board's configuration with what overrides it in how samples are read. */
export interface ReadingConfig extends ReadingOptions {
  /** The text of a `.cfg` file. */
  text: TextInput;
}

/** A board's configuration: the text of a `.cfg` file, or what `studioConfig` makes of mmWave Studio's JSON. */
export type ConfigInput = TextInput | ReadingConfig;

/** Options of the chain from frames to detections. */
export interface ChainOptions extends DetectionOptions {
  /** Default: the preset whose virtual elements match the capture. */
  array?: ArrayInput;
  /** What is known of the array's errors. Default what the board's configuration says. */
  calibration?: ArrayCalibrationInput;
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

/** A capture as a pool is given it. */
export interface CaptureFile {
  /** The `.bin`. */
  bytes: Uint8Array | ArrayBuffer;
}
