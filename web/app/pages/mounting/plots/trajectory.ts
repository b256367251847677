/** Where the radar's own motion takes the car under an angle, and where it really was. */
import { computed, effect, signal } from '@preact/signals';
import type { Drive, DriveCalibration, ScanMotion, Trajectory, TrajectoryOptions } from 'boresight';
import { drop, inTurn } from '../../../../plots/turns.ts';
import { api } from '../../../data.ts';
import { loaded } from '../drive/drive.ts';
import { after } from '../drive/playhead.ts';
import type { Way } from '../motion/ways.ts';
import { results, shown } from '../results/process.ts';
import { mountingState } from '../state.ts';

/** Length of the segments that the relative trajectory error (RTE) is taken over, m. */
export const SEGMENT_M = 50;

/** By the radar alone; null where it is too near the axle's line to tell how the car turns. */
function path(
  { frames, mounting: { xM, yM } }: DriveCalibration,
  angleDeg: number,
  options?: TrajectoryOptions,
): Trajectory | null {
  return api.trajectory(frames, { angleDeg, xM, yM }, options);
}

/** The car's yaw rate as its sensor has it at each frame, less the bias that was found. */
function sensorTurns({ frames, result }: DriveCalibration, { yawRateDegps }: ScanMotion): TrajectoryOptions {
  const bias = Number.isFinite(result.biasDegps) ? result.biasDegps : 0;
  return {
    yawRateDegps: Float64Array.from(frames.scan, (scan) => (yawRateDegps[scan] ?? Number.NaN) - bias),
  };
}

/** What paths are compared with: the log's own poses, else where its speed and yaw rate take the car. */
const reference = computed<{ path: Trajectory; kind: 'poses' | 'odometry' } | null>(() => {
  const { motion } = loaded.value?.drive ?? {};
  if (motion?.pose) return { path: { timeS: motion.timeS, ...motion.pose }, kind: 'poses' };
  return motion?.speedMps.some(Number.isFinite) ? { path: odometry(motion), kind: 'odometry' } : null;
});

const relativeError = (estimated: Trajectory | null): number | null =>
  estimated && reference.value ? api.relativeTrajectoryError(estimated, reference.value.path, SEGMENT_M) : null;

export interface Paths {
  of: DriveCalibration;
  /** With the angle that was found, and with the nominal one. */
  found: Trajectory | null;
  nominal: Trajectory | null;
  /** What they are compared with, from the same start. */
  reference: Trajectory | null;
  kind: 'poses' | 'odometry' | null;
  /** Relative trajectory errors, m. */
  foundError: number | null;
  nominalError: number | null;
}

const heading = computed(() => mountingState.value.heading);

export const paths = signal<Paths | null>(null);

function pathsNow(): Paths | null {
  const calibration = shown.value;
  const motion = loaded.value?.motion;
  if (!calibration || !motion) return null;
  const { nominalDeg } = calibration.mounting;
  const turns = heading.value === 'sensor' ? sensorTurns(calibration, motion) : undefined;
  const found = path(calibration, calibration.result.angleDeg, turns);
  const nominal = nominalDeg === null ? null : path(calibration, nominalDeg, turns);
  return {
    of: calibration,
    found,
    nominal,
    reference: found && reference.value && fromStart(reference.value.path, found),
    kind: reference.value?.kind ?? null,
    foundError: relativeError(found),
    nominalError: relativeError(nominal),
  };
}

/** Errors by calibration, as calibrations stay while others come. */
const known = new WeakMap<DriveCalibration, number | null>();
const found = signal(0);

/** By the radar alone with every method's own motion and angle, as published; of the calibrations that are shown. */
export const relativeErrors = computed<ReadonlyMap<Way, number>>(() => {
  void found.value;
  return new Map(
    [...results.value].flatMap(([way, { calibration }]) => {
      const error = calibration && known.get(calibration);
      return error == null ? [] : [[way, error] as const];
    }),
  );
});

const unknown = (): DriveCalibration | undefined =>
  [...results.peek().values()].flatMap(({ calibration }) => calibration ?? []).find((one) => !known.has(one));

/** Follows the results, a moment behind and a path at a time: nothing seen at first waits for them. */
export function start(): () => void {
  const findPaths = (): void => {
    paths.value = pathsNow();
  };
  const findErrors = (): void => {
    const next = unknown();
    if (!next) {
      found.value += 1;
      return;
    }
    known.set(next, relativeError(path(next, next.result.angleDeg)));
    inTurn(findErrors);
  };
  const stop = effect(() => {
    void [results.value, loaded.value, heading.value];
    // A path of another calibration is not shown meanwhile.
    if (paths.peek()?.of !== shown.value) paths.value = null;
    for (const find of [findPaths, findErrors]) inTurn(find);
  });
  return () => {
    stop();
    for (const find of [findPaths, findErrors]) drop(find);
  };
}

/** By speed and yaw rate as they were measured; between samples with both, their mean. */
function odometry({ timeS, speedMps, yawRateDegps }: Drive['motion']): Trajectory {
  const known = Array.from(timeS.keys()).filter(
    (i) => Number.isFinite(speedMps[i]) && Number.isFinite(yawRateDegps[i]),
  );
  const path = {
    timeS: Float64Array.from(known, (i) => timeS[i] as number),
    xM: new Float64Array(known.length),
    yM: new Float64Array(known.length),
    yawDeg: new Float64Array(known.length),
  };
  for (let k = 1; k < known.length; k++) {
    const [a, b] = [known[k - 1] as number, known[k] as number];
    const dt = (timeS[b] as number) - (timeS[a] as number);
    const turn = (((yawRateDegps[a] as number) + (yawRateDegps[b] as number)) / 2) * dt;
    const way = (((speedMps[a] as number) + (speedMps[b] as number)) / 2) * dt;
    const heading = (((path.yawDeg[k - 1] as number) + turn / 2) * Math.PI) / 180;
    path.xM[k] = (path.xM[k - 1] as number) + way * Math.cos(heading);
    path.yM[k] = (path.yM[k - 1] as number) + way * Math.sin(heading);
    path.yawDeg[k] = (path.yawDeg[k - 1] as number) + turn;
  }
  return path;
}

/** The part in the time of another, turned and moved to begin where that does: at the origin, heading along x. */
function fromStart({ timeS, xM, yM, yawDeg }: Trajectory, other: Trajectory): Trajectory {
  const last = after(timeS, other.timeS[other.timeS.length - 1] ?? 0);
  let first = Math.max(after(timeS, other.timeS[0] ?? 0) - 1, 0);
  while (first < last && !Number.isFinite(xM[first])) first += 1;
  const [x, y, yaw] = [xM[first] ?? 0, yM[first] ?? 0, yawDeg[first] ?? 0];
  const [cos, sin] = [Math.cos((yaw * Math.PI) / 180), Math.sin((yaw * Math.PI) / 180)];
  const numbers = Array.from({ length: Math.max(last - first, 0) }, (_, i) => first + i);
  const of = (value: (i: number) => number): Float64Array => Float64Array.from(numbers, value);
  return {
    timeS: of((i) => timeS[i] as number),
    xM: of((i) => cos * ((xM[i] as number) - x) + sin * ((yM[i] as number) - y)),
    yM: of((i) => cos * ((yM[i] as number) - y) - sin * ((xM[i] as number) - x)),
    yawDeg: of((i) => (yawDeg[i] as number) - yaw),
  };
}
