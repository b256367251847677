/** Mounting angles of one radar. */
import type { CalibrationMethod } from '../generated/options.js';
import type { Warning } from '../types.js';

export interface CalibrationMethodInfo {
  name: CalibrationMethod;
  title: string;
  reference: string;
}

/** One radar frame with the car's motion at that time; arrays have a number for each detection. */
export interface CalibrationFrame {
  /** Must not run backwards. */
  timeS: number;
  /** In the radar's frame. */
  azimuthDeg: Float32Array | Float64Array;
  /** Not compensated for the car's motion. */
  rangeRateMps: Float32Array | Float64Array;
  rangeM?: Float32Array | Float64Array;
  /** As measured; null where there is none at this time. */
  yawRateDegps: number | null;
  /** Forward speed of the rear axle, for the method that needs it. */
  speedMps?: number | null;
}

/** The radar's own motion in its own frame, from one frame. */
export interface RadarMotion {
  velocityMps: [x: number, y: number];
  covariance: [[xx: number, xy: number], [xy: number, yy: number]];
  /** Detections taken as static, and all. */
  inliers: number;
  detections: number;
}

/** What became of a frame. */
export interface FrameOutcome {
  verdict: 'used' | 'standing' | 'slow' | 'turning' | 'sparse' | 'without-motion';
  motion?: RadarMotion;
  /** The angle this frame alone gives, and its standard deviation. */
  angleDeg?: number;
  angleSigmaDeg?: number;
  /** Weight in the estimate, 1/rad^2; 0 if unused. */
  weight: number;
  /** For each detection the weight, 0 to 1, with which it was taken as static. */
  weights: Float32Array;
}

/** How many frames became what. */
export interface CalibrationCounts {
  given: number;
  used: number;
  standing: number;
  slow: number;
  turning: number;
  sparse: number;
  withoutMotion: number;
}

/** A mounting angle and what it rests on. Standard deviations are infinite where the drive says nothing. */
export interface CalibrationResult {
  angleDeg: number;
  sigmaDeg: number;
  /** Of the yaw rate, measured over true; standard deviation 0 where it was not estimated. */
  scale: number;
  scaleSigma: number;
  /** Of the yaw rate. */
  biasDegps: number;
  biasSigmaDegps: number;
  /** Static detections over all, of the frames used. */
  inlierShare: number;
  frames: CalibrationCounts;
  /** The angle has settled. */
  converged: boolean;
  /** Whether it differs from nominal beyond limit and chance; null without a nominal angle. */
  misaligned: boolean | null;
  warnings: Warning[];
}
