import * as glue from '../../wasm/boresight.js';
import { failure, wrong } from '../runtime/errors.js';
import { call } from '../runtime/instance.js';
import type { CalibratedFrames, Trajectory, TrajectoryOptions } from '../types.js';
import { frameVerdicts } from './calibration.js';
import { ascending, doubles, type Floats, floats, positive, Reader } from './view.js';

const MOST_POSES = 1 << 22;

/**
 * Where the car went by the motion of one radar's frames, taken as mounted at this angle and place: from the
 * origin, heading along x. The car turns as the motion tells, or by its yaw rate at each frame where that is
 * given (NaN where it is not); the radar's velocity then moves it sideways where the angle is wrong. Frames
 * without a motion, and sparse ones, are left out; null where xM is too near 0 for the motion to tell the
 * yaw rate.
 *
 * @example
 * ```js
 * import { calibrateDrive, initDrives, init, simulateDrive, trajectory } from 'boresight';
 *
 * await Promise.all([init(), initDrives()]);
 * const drive = simulateDrive({ scenario: 'city', durationS: 60, seed: 1 });
 * const { frames, mounting, result } = calibrateDrive(drive, { sensor: 1 });
 * const { xM, yM } = trajectory(frames, { ...mounting, angleDeg: result.angleDeg });
 * console.log(xM.length === yM.length); // → true
 * ```
 */
export function trajectory(
  frames: CalibratedFrames,
  mounting: { angleDeg: number; xM: number; yM?: number },
  options: TrajectoryOptions = {},
): Trajectory | null {
  const reader = new Reader(frames, 'frames');
  const timeS = counted('frames.timeS', reader.array('timeS', floats));
  const verdict = reader.array('verdict', [Uint8Array], timeS.length);
  const [vx, vy] = [reader.array('vxMps', floats, timeS.length), reader.array('vyMps', floats, timeS.length)];
  const rates = new Reader(options, 'options').maybe('yawRateDegps', floats, timeS.length);
  const place = new Reader(mounting, 'mounting');
  const [angleDeg, xM, yM] = ['angleDeg', 'xM', 'yM'].map((name) => {
    const given = place.get(name) ?? (name === 'yM' ? 0 : undefined);
    if (!Number.isFinite(given)) throw wrong(place.path(name), 'a finite number', given);
    return given as number;
  }) as [number, number, number];
  const sparse = frameVerdicts.indexOf('sparse');
  const kept = Array.from(timeS.keys()).filter(
    (index) => verdict[index] !== sparse && Number.isFinite(vx[index]) && Number.isFinite(vy[index]),
  );
  const of = (values: Floats): Float64Array => Float64Array.from(kept, (index) => values[index] ?? NaN);
  const times = of(timeS);
  ascending('frames.timeS', times);
  return call(
    () =>
      glue.integrateMotion(
        times,
        of(vx),
        of(vy),
        rates ? of(rates) : new Float64Array(),
        angleDeg,
        xM,
        yM,
      ) as Trajectory | null,
  );
}

/**
 * Relative trajectory error, m: the true trajectory, interpolated at the estimated one's times over gaps of at most a
 * second, is cut into segments of a length; both are aligned at each segment's start, and the distances of the ends are
 * averaged. Null where the true one is shorter than a segment.
 */
export function relativeTrajectoryError(estimated: Trajectory, truth: Trajectory, segmentM = 50): number | null {
  positive('segmentM', segmentM);
  const [ours, theirs] = [posesOf(estimated, 'estimated'), posesOf(truth, 'truth')];
  const result = call(() => glue.relativeTrajectoryError(ours.timeS, ours.poses, theirs.timeS, theirs.poses, segmentM));
  return result ?? null;
}

/** Times, and the numbers of the pose at each one after the other. */
function posesOf(value: Trajectory, name: string): { timeS: Float64Array; poses: Float64Array } {
  const reader = new Reader(value, name);
  const timeS = counted(`${name}.timeS`, reader.array('timeS', floats));
  ascending(`${name}.timeS`, timeS);
  const columns = ['xM', 'yM', 'yawDeg'].map((column) => reader.array(column, floats, timeS.length));
  const poses = new Float64Array(3 * timeS.length);
  columns.forEach((column, place) => column.forEach((number, index) => (poses[3 * index + place] = number)));
  return { timeS: doubles(timeS), poses };
}

function counted<T extends Floats>(what: string, values: T): T {
  if (values.length <= MOST_POSES) return values;
  throw failure('out-of-range', { what, expected: `at most ${MOST_POSES} times`, given: String(values.length) });
}
