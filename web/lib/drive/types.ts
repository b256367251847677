/**
 * Drives, and calibration over whole drives. A drive is a plain object of flat typed arrays, so that
 * one can be made of any data and sent to a worker.
 */
import type {
  CalibrationFrame,
  CalibrationMethod,
  CalibrationOptions,
  CalibrationResult,
  DriveScenario,
  FrameOutcome,
  Warning,
} from '../types.js';

type Floats = Float32Array | Float64Array;

/** A radar of a drive: its place from the rear axle and nominal direction, null where the log does not say. */
export interface DriveSensor {
  /** Its number in the log, 0 to 255. */
  id: number;
  xM: number | null;
  yM: number | null;
  yawDeg: number | null;
}

/** Radar scans in order of time; the detections of scan i are those from offsets[i] to before offsets[i + 1]. */
export interface DriveScans {
  timeS: Float64Array;
  /** Numbers of the radars. */
  sensor: Uint8Array;
  /** One more than there are scans. */
  offsets: Uint32Array;
}

/**
 * What calibration needs of a drive. Detections have an entry for each, motion one for each sample in order of time.
 */
export interface DriveData {
  sensors: readonly DriveSensor[];
  scans: DriveScans;
  detections: {
    /** In the radar's frame. */
    azimuthDeg: Floats;
    /** Not compensated for the car's motion. */
    rangeRateMps: Floats;
    /** NaN where there is none, as in the next. */
    rangeM?: Floats | null;
    rcsDbsm?: Floats | null;
    label?: Uint8Array | null;
  };
  motion: {
    timeS: Float64Array;
    /** As measured. */
    yawRateDegps: Floats;
    /** Of the rear axle, negative in reverse; NaN where there is none. */
    speedMps?: Floats | null;
    /** Where the rear axle is; NaN where that is not known. */
    pose?: { xM: Floats; yM: Floats; yawDeg: Floats } | null;
  };
}

/** A format of drive logs. */
export type DriveFormat = 'radarscenes' | 'delphi' | 'csv';

/**
 * A file of a drive. Its name, with or without folders before it, tells tables (`.csv`, `.csv.gz`), HDF5 (`.h5`,
 * `.hdf5`) and what stands beside that (`scenes.json`, `sensors.json`, `sequences.json`) from the rest.
 */
export interface DriveFile {
  name: string;
  bytes: Uint8Array | ArrayBuffer;
}

export interface ReadDriveOptions {
  /** Default: found from the files' contents. */
  format?: DriveFormat;
}

/** A drive as read or simulated. */
export interface Drive extends DriveData {
  format: DriveFormat | 'simulated';
  sensors: DriveSensor[];
  /** Where the sensors' places are from, if read: `sensors.json` of the files, or the format's own car. */
  mountings: 'sensors-json' | 'format' | null;
  detections: {
    azimuthDeg: Float64Array;
    rangeRateMps: Float32Array;
    rangeM: Float32Array;
    rcsDbsm: Float32Array;
    /** Classes in the numbers of RadarScenes (11 is static), where the log has them. */
    label: Uint8Array | null;
  };
  motion: {
    timeS: Float64Array;
    yawRateDegps: Float64Array;
    speedMps: Float64Array;
    pose: { xM: Float64Array; yM: Float64Array; yawDeg: Float64Array } | null;
  };
  counts: DriveCounts;
  warnings: Warning[];
}

/** What the files held. */
export interface DriveCounts {
  /** Detections in the files. */
  detections: number;
  /** Motion samples in the files. */
  motion: number;
  /** Detections kept although their range, cross-section, compensated rate or place is no number. */
  incompleteDetections: number;
  /** Motion samples kept although their speed or pose is no number. */
  incompleteMotion: number;
  /**
   * Rows left out, by reason: `not-finite`, `invalid-marker`, `status`, `duplicate`, `motion-not-finite`,
   * `motion-duplicate`.
   */
  dropped: Record<string, number>;
}

export interface DriveScenarioInfo {
  name: DriveScenario;
  title: string;
}

/** A simulated drive with the truth behind it; its poses are the true ones. */
export interface SimulatedDrive extends Drive {
  truth: DriveTruth;
}

export interface DriveTruth {
  /** The radars where they truly sit and look. */
  sensors: { id: number; xM: number; yM: number; yawDeg: number }[];
  /** Errors of the yaw-rate sensor. */
  yawRate: { scale: number; biasDegps: number; sigmaDegps: number };
  /** At the times of the drive's motion. */
  motion: { yawRateDegps: Float64Array; speedMps: Float64Array };
  /** For each detection, 1 where it comes from a moving road user. */
  moving: Uint8Array;
  /** For each detection, the number of the road user it comes from, or 0. */
  track: Uint32Array;
}

/** A scan of a drive with the car's motion at its time; its arrays are views of the drive's. */
export interface DriveFrame extends CalibrationFrame {
  sensor: number;
  rcsDbsm?: Floats;
  label?: Uint8Array;
}

/** How far the motion is interpolated. */
export interface MotionGap {
  /** Longest gap between samples of the motion that is bridged, default 0.25. */
  maxGapS?: number;
}

/** Place and nominal angle default to those of the drive's sensor, the method to `recursive`. */
export interface CalibrateDriveOptions extends Partial<CalibrationOptions>, MotionGap {
  /** Number of the radar; needed where the drive has several. */
  sensor?: number;
  /** Time between entries of the history, default 1. */
  historyS?: number;
  /** Whether to give the weight of each detection too. */
  weights?: boolean;
}

/** Radars whose angles are estimated together by the recursive method, with one scale and bias of the yaw rate. */
export interface JointCalibrationOptions
  extends Omit<Partial<CalibrationOptions>, 'method' | 'motion' | 'xM' | 'yM' | 'nominalDeg'>,
    MotionGap {
  /** Default: all radars of the drive, each as the drive has it. */
  sensors?: readonly (number | { sensor: number; xM?: number; yM?: number; nominalDeg?: number })[];
  historyS?: number;
  weights?: boolean;
}

/** What became of a frame, in the order of the numbers in {@link CalibratedFrames}. */
export type FrameVerdict = FrameOutcome['verdict'];

/** The angle of a radar of a drive. */
export interface DriveCalibration {
  sensor: number;
  method: CalibrationMethod;
  /** The place and nominal angle it was calibrated with. */
  mounting: { xM: number; yM: number; nominalDeg: number | null };
  result: CalibrationResult;
  history: AngleHistory;
  frames: CalibratedFrames;
}

/**
 * The estimate after the frames up to a time, in steps of historyS; the last entry has all frames. The
 * methods that weigh all frames at once are asked after every hundredth of the frames so far at most.
 */
export interface AngleHistory {
  timeS: Float64Array;
  angleDeg: Float64Array;
  /** Infinite where the drive says nothing yet. */
  sigmaDeg: Float64Array;
}

/** What became of each frame of the radar, in order; NaN where there is none. */
export interface CalibratedFrames {
  /** Number of the scan in the drive. */
  scan: Uint32Array;
  timeS: Float64Array;
  /** Place in `frameVerdicts`. */
  verdict: Uint8Array;
  /** The radar's own motion in its own frame. */
  vxMps: Float32Array;
  vyMps: Float32Array;
  /** The angle the frame alone gives. */
  angleDeg: Float32Array;
  angleSigmaDeg: Float32Array;
  /** Weight in the estimate, 1/rad^2. */
  weight: Float32Array;
  /** Detections taken as static. */
  inliers: Uint16Array;
  /** If asked for: the weight of each detection, 0 to 1, those of frame i from offsets[i] to before offsets[i + 1]. */
  weights?: { offsets: Uint32Array; values: Float32Array };
}

export interface TrajectoryOptions {
  /** Yaw rate of the car at each frame, NaN where none is known. Default: what the radar's motion implies. */
  yawRateDegps?: Floats;
}

/** Poses of the rear axle. */
export interface Trajectory {
  timeS: Floats;
  xM: Floats;
  yM: Floats;
  yawDeg: Floats;
}
