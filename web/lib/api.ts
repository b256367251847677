// What every runtime's entry offers beside its own init().

export { array, arrayPresets } from './arrays.js';
export { BoardLogStream, parseBoardLog } from './board.js';
export { Calibration, calibrationMethods } from './calibrate.js';
export { Capture, processCube } from './capture.js';
export { parseConfig, waveformSummary } from './config.js';
export { driveScenarios, initDrivesSync, readDrive, simulateDrive } from './drive.js';
export { calibrateDrive, frameVerdicts, jointCalibration } from './drive-calibration.js';
export { driveFrame } from './drive-view.js';
export { BoresightError, type ErrorDetails } from './errors.js';
export { Estimator, estimate, methods, unsuited } from './estimate.js';
export {
  readDetectionsCsv,
  readNpy,
  readSnapshotsCsv,
  writeDetectionsCsv,
  writeNpy,
  writeSnapshotsCsv,
} from './files.js';
export {
  birdsEyeView,
  frameCells,
  imageFrame,
  imagePlan,
  rangeAzimuthMap,
  sidelobeMeasure,
  simulateStreet,
  streetScene,
} from './image.js';
export { initSync } from './instance.js';
export type { WasmSource } from './module.js';
export type { Report } from './report.js';
export { simulateCube, simulateSnapshots } from './simulate.js';
export { countSources, cramerRaoBound } from './theory.js';
export { relativeTrajectoryError, trajectory } from './trajectory.js';
export type * from './types.js';
export { version } from './version.js';
