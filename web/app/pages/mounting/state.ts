/** State of the mounting-angle page: all of it in the address but the files themselves. */
import { signal } from '@preact/signals';
import type { CalibrationOptions, DriveSensor, MotionMethod } from 'boresight';
import { choice, codec, flag, names, number, optional } from '../../state/codec.ts';
import { WAYS, type Way } from './ways.ts';

export const MOTIONS: readonly MotionMethod[] = ['ransac', 'weighted-least-squares', 'orthogonal-distance', 'tracked'];
export const SCENARIOS = ['city', 'country-road', 'motorway', 'car-park', 'stop-and-go', 'dense-traffic'] as const;
export const SPEEDS = ['0.5', '1', '2', '5', '10', '30'] as const;

export const LIMITS = {
  seed: [0, 4294967295],
  durationS: [5, 3600],
  movingPercent: [0, 80],
  misalignmentDeg: [-20, 20],
  placeM: [-100, 100],
  angleDeg: [-180, 180],
  minSpeedMps: [0, 100],
  maxYawRateDegps: [0.1, 180],
  alarmDeg: [0.01, 45],
  convergedDeg: [0.001, 45],
  rangeRateSigmaMps: [0.001, 10],
  azimuthSigmaDeg: [0, 45],
  inlierResidualMps: [0.001, 10],
  share: [0, 1],
  minInliers: [3, 200],
} as const;

export const mountingCodec = codec(
  {
    source: choice('delphi', ['delphi', 'simulated', 'files']),
    scenario: choice('city', SCENARIOS),
    seed: number(1, LIMITS.seed, 'integer'),
    duration: number(60, LIMITS.durationS),
    /** Percent; null for what the scenario's traffic gives. */
    moving: optional(number(0, LIMITS.movingPercent)),
    misalignment: number(1.5, LIMITS.misalignmentDeg),
    /** The radar's number; null for the first. */
    sensor: optional(number(0, [0, 255], 'integer')),
    methods: names<Way>(['recursive', 'weighted-mean', 'least-squares'], WAYS),
    /** Whose frames are shown. */
    shown: choice<Way>('recursive', WAYS),
    /** Null for what the drive says. */
    xM: optional(number(0, LIMITS.placeM)),
    yM: optional(number(0, LIMITS.placeM)),
    nominal: optional(number(0, LIMITS.angleDeg)),
    alarm: number(1, LIMITS.alarmDeg),
    converged: number(0.1, LIMITS.convergedDeg),
    motion: choice('auto', ['auto', ...MOTIONS]),
    /** Null for what suits the drive. */
    minSpeed: optional(number(0, LIMITS.minSpeedMps)),
    maxYawRate: number(140, LIMITS.maxYawRateDegps),
    rangeRateSigma: number(0.1, LIMITS.rangeRateSigmaMps),
    azimuthSigma: number(0.5, LIMITS.azimuthSigmaDeg),
    inlierResidual: number(0.3, LIMITS.inlierResidualMps),
    inlierRatio: number(0.3, LIMITS.share),
    minInliers: number(5, LIMITS.minInliers, 'integer'),
    band: choice('1', ['1', '2']),
    singles: flag(true),
    residual: flag(false),
    /** What turns the car in its trajectory. */
    heading: choice('sensor', ['sensor', 'radar']),
    speed: choice('5', SPEEDS),
    /** The time that is shown, s; null for a moment worth seeing. */
    t: optional(number(0, [-1e9, 1e12])),
  },
  ['source', 'methods'],
);

export type MountingState = Omit<typeof mountingCodec.defaults, 't'>;
const { t: _, ...defaults } = mountingCodec.defaults;
export const mountingState = signal<MountingState>(defaults);

/** Back to the settings of a fresh visit; the drive stays. */
export function restoreDefaults(): void {
  const { source, scenario, seed, duration, moving, misalignment } = mountingState.value;
  mountingState.value = { ...defaults, source, scenario, seed, duration, moving, misalignment };
}

export function update(patch: Partial<MountingState>): void {
  mountingState.value = { ...mountingState.value, ...patch };
}

/** Where the radar is taken to be; x is null where neither the drive nor the user says. */
export interface Place {
  xM: number | null;
  yM: number;
  nominalDeg: number | null;
}

export function place(state: MountingState, sensor: DriveSensor): Place {
  return { xM: state.xM ?? sensor.xM, yM: state.yM ?? sensor.yM ?? 0, nominalDeg: state.nominal ?? sensor.yawDeg };
}

/** Slowest frames to use, m/s: tracked objects say little of a slow car. */
export function minSpeed(state: MountingState, format: string): number {
  return state.minSpeed ?? (format === 'delphi' ? 3 : 1);
}

/** The part of the state that the angle depends on, as the package takes it; a method comes with each job. */
export function calibrationOptions(
  state: MountingState,
  where: Place,
  format: string,
): Omit<CalibrationOptions, 'method'> | null {
  if (where.xM === null) return null;
  return {
    xM: where.xM,
    yM: where.yM,
    ...(where.nominalDeg === null ? {} : { nominalDeg: where.nominalDeg }),
    ...(state.motion === 'auto' ? {} : { motion: state.motion }),
    alarmDeg: state.alarm,
    convergedDeg: state.converged,
    minSpeedMps: minSpeed(state, format),
    maxYawRateDegps: state.maxYawRate,
    rangeRateSigmaMps: state.rangeRateSigma,
    azimuthSigmaDeg: state.azimuthSigma,
    inlierResidualMps: state.inlierResidual,
    inlierRatioThreshold: state.inlierRatio,
    minInliers: state.minInliers,
  };
}
