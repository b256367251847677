/**
 * Drives, and calibration over whole drives. A drive is a plain object of flat typed arrays, so that
 * one can be made of any data and sent to a worker.
 */
import type {
  CalibrationFrame,
  CalibrationMethod,
  CalibrationOptions,
  CalibrationOutlook,
  CalibrationResult,
  DriveScans,
  DriveSensor,
  MotionNetwork,
} from '../types.js';

type Floats = Float32Array | Float64Array;

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

/**
 * A file of a drive. Its name, with or without folders before it, tells tables (`.csv`, `.csv.gz`), HDF5 (`.h5`,
 * `.hdf5`), point clouds (`.pcd`), frames of View-of-Delft (`00549.bin`) and what stands beside them (`scenes.json`,
 * `sensors.json`, `sequences.json`; `sample_data.json`, `ego_pose.json` and others of nuScenes) from the rest. Of clouds
 * whose names have a time alone, the folder names the radar.
 */
export interface DriveFile {
  name: string;
  bytes: Uint8Array | ArrayBuffer;
}

/** A recording that is read piece by piece: a file, or what gives its bytes. */
export type Recording = Blob | AsyncIterable<Uint8Array>;

/** A scan of a drive with the car's motion at its time; its arrays are views of the drive's. */
export interface DriveFrame extends CalibrationFrame {
  sensor: number;
  rcsDbsm?: Floats;
  label?: Uint8Array;
}

/** The car's motion at the times of a drive's scans, an entry for each; NaN where it is not known. */
export interface ScanMotion {
  yawRateDegps: Floats;
  /** Of the rear axle, negative in reverse. */
  speedMps: Floats;
}

/** How far the motion is interpolated. */
export interface MotionGap {
  /** Longest gap between samples of the motion that is bridged, default 0.25. */
  maxGapS?: number;
}

/** Place and nominal angle default to those of the drive's sensor, the method to `recursive`. */
export interface CalibrateDriveOptions extends Partial<CalibrationOptions>, MotionNetwork, MotionGap {
  /** Number of the radar; needed where the drive has several. */
  sensor?: number;
  /** Time between entries of the history, default 1. */
  historyS?: number;
  /** Whether to give the weight of each detection too. */
  weights?: boolean;
}

/** Radars whose angles are estimated together by the recursive method, with one scale and bias of the yaw rate. */
export interface JointCalibrationOptions
  extends Omit<Partial<CalibrationOptions>, 'method' | 'xM' | 'yM' | 'nominalDeg'>,
    MotionNetwork,
    MotionGap {
  /** Default: all radars of the drive, each as the drive has it. */
  sensors?: readonly (number | { sensor: number; xM?: number; yM?: number; nominalDeg?: number })[];
  /** Least time between points of the history, s. Default 1. */
  historyS?: number;
  /** Whether the weights of all detections are kept. Default false. */
  weights?: boolean;
}

/** What a report says of where it comes from. */
export interface ReportAbout {
  /** When it was made, in words. */
  made?: string;
  /** How it was asked for. */
  asked?: string;
  /** The files of the drive, with the SHA-256 of their bytes in hexadecimal digits. */
  sources?: readonly { name: string; bytes: number; sha256: string }[];
}

/** The angle of a radar of a drive. */
export interface DriveCalibration {
  sensor: number;
  method: CalibrationMethod;
  /** The place and nominal angle it was calibrated with. */
  mounting: { xM: number; yM: number; nominalDeg: number | null };
  result: CalibrationResult;
  /** What driving on would bring; null of several radars together, and by the methods that weigh all frames at once. */
  outlook: CalibrationOutlook | null;
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

/** What a trajectory turns by. */
export interface TrajectoryOptions {
  /** Yaw rate of the car at each frame, NaN where none is known. Default: what the radar's motion implies. */
  yawRateDegps?: Floats;
}
