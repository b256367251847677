import * as glue from '../../wasm/boresight.js';
import { call } from '../runtime/instance.js';
import type { Report } from '../runtime/report.js';
import type {
  ArrayCalibration,
  ArrayCalibrationResult,
  ArrayInput,
  CalibrationCells,
  CellCalibrationOptions,
  ComplexData,
  CubeCalibrationOptions,
  SteeringTable,
  TextInput,
} from '../types.js';

/**
 * Gain and phase of each channel of an array, and on request positions and coupling, from cells with one strong target
 * each. Captures have a method of this name, which finds the cells.
 */
export function calibrateArray(cells: CalibrationCells, options: CellCalibrationOptions): ArrayCalibrationResult {
  return call(() => glue.calibrateArray(cells, options) as ArrayCalibrationResult);
}

/** The same from frames of a cube (frames x loops x transmitters x receivers x samples), whose cells are found. */
export function calibrateCubeArray(
  cube: ComplexData,
  options: CubeCalibrationOptions,
  report?: Report,
): ArrayCalibrationResult {
  return call(() => glue.calibrateCubeArray(cube, options, report) as ArrayCalibrationResult);
}

/** The calibration that turns an array's plan into a table of measured steering vectors best. */
export function calibrateBySteeringTable(table: SteeringTable, array: ArrayInput): ArrayCalibrationResult {
  return call(() => glue.calibrateBySteeringTable(table, array) as ArrayCalibrationResult);
}

/**
 * The calibration that the coefficients in a board's configuration are (`compRangeBiasAndRxChanPhase`), by which its captures
 * are processed unless told otherwise; null where there are none to apply. `array` is the platform's by default.
 */
export function configuredCalibration(config: TextInput, array?: ArrayInput): ArrayCalibration | null {
  return call(() => glue.configuredCalibration(config, array) as ArrayCalibration | null);
}

/**
 * The line `compRangeBiasAndRxChanPhase` that makes a TI board apply a calibration, for the board whose configuration
 * (`.cfg`) this is.
 */
export function tiCompensation(calibration: ArrayCalibration, config: TextInput): string {
  return call(() => glue.tiCompensation(calibration, config));
}
