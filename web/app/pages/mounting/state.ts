/** State of the mounting-angle page: all of it in the address but the files themselves. */
import { signal } from '@preact/signals';
import type { CalibrationOptions, DriveSensor } from 'boresight';
import { optionsOf, percent } from '../../options.ts';
import { choice, codec, flag, names, number, optional, text } from '../../state/codec.ts';
import { seed } from '../../state/seed.ts';
import { address } from './live/address.ts';
import { WAYS, type Way } from './motion/ways.ts';

export const SPEEDS = ['0.5', '1', '2', '5', '10', '30'] as const;

const drive = optionsOf('SimulateDriveOptions');
const calibration = optionsOf('CalibrationOptions');
export const USUAL_SPEED = calibration.field('minSpeedMps').fallback;

const topic = text('', (name) => name.length <= 200);

export const mountingCodec = codec(
  {
    source: choice('delphi', ['delphi', 'simulated', 'live', 'files']),
    scenario: drive.field('scenario'),
    profile: drive.field('profile'),
    seed,
    /** At most what four radars may last. */
    duration: drive.field('durationS', { max: 3600 }),
    moving: percent(drive.maybe('movingShare')),
    /** Of all radars, and worth finding by default. The recursive method finds back from no farther. */
    misalignment: drive.field('misalignmentDeg.0', { fallback: 1.5, min: -20, max: 20 }),
    /** The live server's address, and its topics; empty for the first that fits. */
    server: address,
    scanTopic: topic,
    motionTopic: topic,
    /** Where azimuths and range rates of its scans are positive. */
    azimuthSign: choice('left', ['left', 'right']),
    rangeRateSign: choice('receding', ['receding', 'closing']),
    /** The radar's number; null for the first. */
    sensor: optional(number(0, [0, 255], 'integer')),
    methods: names<Way>(['recursive', 'weighted-mean', 'least-squares'], WAYS),
    /** Whose frames are shown. */
    shown: choice<Way>('recursive', WAYS),
    // Null for what the drive says.
    xM: calibration.maybe('xM'),
    yM: calibration.maybe('yM'),
    nominal: calibration.maybe('nominalDeg'),
    alarm: calibration.field('alarmDeg'),
    converged: calibration.field('convergedDeg'),
    motion: calibration.or('motion', 'auto'),
    /** Null for what suits the drive. */
    minSpeed: calibration.maybe('minSpeedMps'),
    maxYawRate: calibration.field('maxYawRateDegps'),
    rangeRateSigma: calibration.field('rangeRateSigmaMps'),
    azimuthSigma: calibration.field('azimuthSigmaDeg'),
    inlierResidual: calibration.field('inlierResidualMps'),
    inlierRatio: calibration.field('inlierRatioThreshold'),
    minInliers: calibration.field('minInliers'),
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
  const { source, scenario, profile, seed, duration, moving, misalignment, server } = mountingState.value;
  mountingState.value = { ...defaults, source, scenario, profile, seed, duration, moving, misalignment, server };
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
export const TRACKED_SPEED = 3;

export function minSpeed(state: MountingState, format: string): number {
  return state.minSpeed ?? (format === 'delphi' ? TRACKED_SPEED : USUAL_SPEED);
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
