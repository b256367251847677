/** The network of a motion: the bytes of `models/motion/deepego.bin`, of `models/motion/deepego-plus.bin`, or of weights of one's own. */
export interface MotionNetwork {
  /** What `motion: 'deepego'` and `motion: 'deepego-plus'` need. */
  network?: Uint8Array | ArrayBuffer;
}

/** One radar frame with the car's motion at that time; arrays have a number for each detection. */
export interface CalibrationFrame {
  /** Must not run backwards within a session. */
  timeS: number;
  /** In the radar's frame. */
  azimuthDeg: Float32Array | Float64Array;
  /** Not compensated for the car's motion. */
  rangeRateMps: Float32Array | Float64Array;
  /** NaN where there is none, as in the next; networks of motion look at both. */
  rangeM?: Float32Array | Float64Array | null;
  rcsDbsm?: Float32Array | Float64Array | null;
  /** As measured; null where there is none at this time. */
  yawRateDegps: number | null;
  /** Forward speed of the rear axle, for the method that needs it. */
  speedMps?: number | null;
}
