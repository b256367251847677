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
