// What every runtime's entry offers beside its own init().

export {
  calibrateArray,
  calibrateBySteeringTable,
  calibrateCubeArray,
  configuredCalibration,
  tiCompensation,
} from './array-calibration/array-calibration.js';
export { Capture, frameCells, joinCascade, processCube, recordingParts } from './capture/capture.js';
export { strongestRegion } from './capture/region.js';
export { calibrateDrive, calibrationReport, frameVerdicts, jointCalibration } from './drive/calibration.js';
export { driveScenarios, initDrivesSync, readDrive, simulateDrive } from './drive/drive.js';
export { driveFrame, scanMotion } from './drive/frame.js';
export { DriveStream } from './drive/stream.js';
export { relativeTrajectoryError, trajectory } from './drive/trajectory.js';
export { Estimator, estimate, methods, unsuited } from './estimate/estimate.js';
export { countSources, cramerRaoBound } from './estimate/theory.js';
export { BoardLogStream, parseBoardLog } from './formats/board.js';
export { parseConfig, subFrameConfig } from './formats/config.js';
export { readDetectionsCsv, readSnapshotsCsv, writeDetectionsCsv, writeSnapshotsCsv } from './formats/csv.js';
export { listArrays, readArray } from './formats/hdf5.js';
export { readNpy, writeNpy } from './formats/npy.js';
export { studioConfig } from './formats/studio.js';
export { birdsEyeView, imageFrame, imagePlan, rangeAzimuthMap, sidelobeMeasure } from './image/image.js';
export { type BoardFrames, boardFrames } from './live/board-frames.js';
export { type BridgeFrames, bridgeFrames } from './live/bridge.js';
export { sendConfiguration } from './live/configuration.js';
export { RecentBytes } from './live/recent-bytes.js';
export { replayBytes } from './live/replay.js';
export { type SerialBytes, serialBytes } from './live/serial.js';
export { Calibration, calibrationMethods, mergeCalibrations } from './mounting/calibrate.js';
export { array, arrayPresets } from './radar/array.js';
export { waveformPreset, waveformPresets, waveformSummary } from './radar/waveform.js';
export { BoresightError, type ErrorDetails } from './runtime/errors.js';
export { initSync } from './runtime/instance.js';
export { setLimits } from './runtime/limits.js';
export type { WasmSource } from './runtime/module.js';
export type { Report } from './runtime/report.js';
export { version } from './runtime/version.js';
export { simulateCube, simulateSnapshots } from './simulate/simulate.js';
export { simulateStreet, streetScene } from './simulate/street.js';
export type * from './types.js';
