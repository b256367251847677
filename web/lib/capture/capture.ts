import * as glue from '../../wasm/boresight.js';
import { Handle } from '../runtime/handle.js';
import { call, core } from '../runtime/instance.js';
import type { Report } from '../runtime/report.js';
import type {
  AngleOptions,
  ArrayCalibrationResult,
  BytesInput,
  CaptureCalibrationOptions,
  CaptureInfo,
  CascadeCapture,
  Cell,
  CellExplanation,
  ChainOptions,
  CombineOptions,
  ComplexData,
  ConfigInput,
  CubeChainOptions,
  DriveFile,
  Estimate,
  FrameCells,
  FrameResult,
  RecordingParts,
} from '../types.js';

/** A raw capture (`.bin` of a DCA1000) with the board's configuration (`.cfg`). */
export class Capture extends Handle<glue.Capture> {
  /** What is known before any processing. */
  readonly info: CaptureInfo;

  constructor(bytes: BytesInput, config: ConfigInput) {
    super(core, () => new glue.Capture(bytes, config));
    this.info = this.use((raw) => raw.info() as CaptureInfo);
  }

  /** Detections of one frame, from 0. */
  processFrame(frame: number, options?: ChainOptions): FrameResult {
    return this.use((raw) => raw.processFrame(frame, options) as FrameResult);
  }

  /** Detected cells of one frame, with what estimators take; angles are not estimated. */
  frameCells(frame: number, options?: ChainOptions): FrameCells {
    return this.use((raw) => raw.frameCells(frame, options) as FrameCells);
  }

  /**
   * Detections of all frames, or of some, together: for scenes that stand still, and for methods
   * that need more than one snapshot. Throws the code `cancelled` if `report` stops it.
   */
  combineFrames(options?: CombineOptions, report?: Report): FrameResult {
    return this.use((raw) => raw.combineFrames(options, report) as FrameResult);
  }

  /** Snapshots of a cell (elements x frames), compensated for the transmitters' turns. */
  cellSnapshots(cell: Cell, options?: ChainOptions): ComplexData {
    return this.use((raw) => raw.cellSnapshots(cell, options) as ComplexData);
  }

  /** Why a cell is a detection or none: its power, noise and threshold, and what became of it. */
  explainCell(cell: Cell, options?: ChainOptions): CellExplanation {
    return this.use((raw) => raw.explainCell(cell, options) as CellExplanation);
  }

  /**
   * Gain and phase of each channel of the array, from the reflectors that the options name or else from all strong cells
   * with one target, of the first half of the frames; the other half checks it. Throws the code `cancelled` if `report`
   * stops it.
   */
  calibrateArray(options?: CaptureCalibrationOptions, report?: Report): ArrayCalibrationResult {
    return this.use((raw) => raw.calibrateArray(options, report) as ArrayCalibrationResult);
  }

  /** Angles and spectrum of a cell by any method. */
  cellSpectrum(cell: Cell, angle?: AngleOptions, options?: ChainOptions): Estimate {
    return this.use((raw) => raw.cellSpectrum(cell, angle, options) as Estimate);
  }
}

/**
 * Orders the files of one recording by their names: `adc_data_Raw_0.bin`, `adc_data_Raw_1.bin` and so on, whose
 * bytes follow one another, or those of a cascade, for {@link joinCascade}.
 *
 * @throws BoresightError `recording-parts` for files of several recordings.
 */
export function recordingParts(names: readonly string[]): RecordingParts {
  return call(() => glue.recordingParts(names) as RecordingParts);
}

/**
 * Puts the files of a cascade of four chips (`master_0000_data.bin`, `slave1_0000_data.bin` and so on, and `..._idx.bin`
 * where they are there) together to the bytes of a {@link Capture} of the same configuration, whose `channelCfg` says
 * that chips are cascaded.
 */
export function joinCascade(files: readonly DriveFile[], config: ConfigInput): CascadeCapture {
  return call(() => glue.joinCascade(files, config) as CascadeCapture);
}

/** Detections of each frame of a cube (frames x loops x transmitters x receivers x samples). */
export function processCube(cube: ComplexData, options: CubeChainOptions): FrameResult[] {
  return call(() => glue.processCube(cube, options) as FrameResult[]);
}

/** Detected cells of a cube of one frame, with what estimators take; angles are not estimated. */
export function frameCells(cube: ComplexData, options: CubeChainOptions): FrameCells {
  return call(() => glue.frameCells(cube, options) as FrameCells);
}
