/** Calibration of arrays. */
import type { ArrayCalibrationOptions } from '../generated/options.js';
import type { ArrayCalibration } from '../generated/results.js';
import type { ArrayInput, ComplexData, Waveform } from '../types.js';

/** A calibration as `calibrateArray` gives it; 'none' leaves out that of a board's configuration. */
export type ArrayCalibrationInput = ArrayCalibration | 'none';

/** How a capture calibrates its array. */
export interface CaptureCalibrationOptions extends ArrayCalibrationOptions {
  /** Default: the preset whose virtual elements match the capture. */
  array?: ArrayInput;
  /** First frame it is made from. Default 0. */
  firstFrame?: number;
  /** Frames it is made from. Default the first half, or all from `firstFrame`. */
  frameCount?: number;
  /** First frame it is checked on. Default the one after those it is made from. */
  checkFirstFrame?: number;
  /** Frames it is checked on. Default all that are left. */
  checkFrameCount?: number;
}

/** How a cube calibrates its array. */
export interface CubeCalibrationOptions extends CaptureCalibrationOptions {
  waveform: Waveform;
  array: ArrayInput;
}

/** How cells calibrate an array. */
export interface CellCalibrationOptions extends ArrayCalibrationOptions {
  /** A preset by name, or transmitters and receivers; all of its channels are seen. */
  array: ArrayInput;
}

/** Cells with one strong target each, seen by all channels of an array. */
export interface CalibrationCells {
  /** [cells, channels] or [cells, channels, snapshots]. */
  snapshots: ComplexData;
  /** Power of noise in one channel of a snapshot. */
  noisePower: number;
  /** Azimuth of each cell's target, positive to the left, where all are known. */
  azimuthDeg?: readonly number[];
  /** Elevation of each, positive upwards. Default 0. */
  elevationDeg?: readonly number[];
}
