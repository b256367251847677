// What every runtime's entry offers beside its own init().
export type * from './types.js';
export { BoresightError, type ErrorDetails } from './errors.js';
export { initSync } from './instance.js';
export type { WasmSource } from './module.js';
export { version } from './version.js';
export { array, arrayPresets } from './arrays.js';
export { Estimator, estimate, methods } from './estimate.js';
export { parseConfig, waveformSummary } from './config.js';
export { BoardLogStream, parseBoardLog } from './board.js';
export { readDetectionsCsv, readNpy, readSnapshotsCsv, writeDetectionsCsv, writeNpy, writeSnapshotsCsv } from './files.js';
export { countSources, cramerRaoBound } from './theory.js';
export { simulateCube, simulateSnapshots } from './simulate.js';
export { Capture, processCube } from './capture.js';
export {
  birdsEyeView, frameCells, imageFrame, imagePlan, rangeAzimuthMap, sidelobeMeasure, simulateStreet, streetScene,
} from './image.js';
export type { Report } from './report.js';
export { Calibration, calibrationMethods } from './calibrate.js';
export { driveScenarios, initDrivesSync, readDrive, simulateDrive } from './drive.js';
export { driveFrame } from './drive-view.js';
export { calibrateDrive, frameVerdicts, jointCalibration } from './drive-calibration.js';
export { relativeTrajectoryError, trajectory } from './trajectory.js';
