// Which radars of a drive are calibrated, and how each sits on the car.
import { failure, own, reading, wrong } from '../runtime/errors.js';
import { isArray } from '../runtime/given.js';
import type {
  CalibrateDriveOptions,
  CalibrationOptions,
  DriveSensor,
  JointCalibrationOptions,
  MotionNetwork,
} from '../types.js';
import { gapOf, positive, type View } from './view.js';

/** A radar with its options as {@link Calibration} takes them. */
export interface Radar {
  sensor: number;
  options: CalibrationOptions & MotionNetwork;
}

/** Whether ranges and cross-sections are looked at: by a network. */
export const needsMore = (radars: readonly Radar[]): boolean =>
  radars.some(({ options }) => options.network !== undefined);

/** What is asked for of a drive. */
export interface Task {
  radars: Radar[];
  joint: boolean;
  historyS: number;
  maxGapS: number;
  weights: boolean;
  /** Whether a report is wanted of it. */
  recorded: boolean;
}

/** The task of a report: of one radar, or of several together where they are named. */
export function reportTaskOf(view: View, options: CalibrateDriveOptions | JointCalibrationOptions | undefined): Task {
  const together = reading('options', () => typeof options === 'object' && options !== null && 'sensors' in options);
  const task = together ? jointTaskOf(view, options) : taskOf(view, options as CalibrateDriveOptions | undefined);
  return { ...task, recorded: true };
}

/** The task of a calibration of one radar. */
export function taskOf(view: View, options: CalibrateDriveOptions | undefined): Task {
  const { sensor, historyS, maxGapS, weights, ...rest } = own(options, 'options');
  const radar = known(view, 'sensor', sensor ?? (view.sensors.length === 1 ? view.sensors[0]?.id : undefined));
  return { radars: [placed(radar, rest)], joint: false, ...settings({ historyS, maxGapS, weights }) };
}

/** The task of a joint calibration. */
export function jointTaskOf(view: View, options: JointCalibrationOptions | undefined): Task {
  const { sensors, historyS, maxGapS, weights, ...rest } = own(options, 'options');
  for (const name of ['method', 'xM', 'yM', 'nominalDeg']) {
    if (name in rest)
      throw failure('unknown-option', {
        what: name,
        expected: 'an option of all radars',
        given: 'one of a single radar',
      });
  }
  const given: unknown = sensors ?? view.sensors.map(({ id }) => id);
  const asked = reading('sensors', () => (isArray(given) && given.length <= 256 ? Array.from(given) : []));
  if (asked.length === 0) throw wrong('sensors', 'an array of 1 to 256 radars', given);
  const radars = asked.map((item, index) => {
    const path = `sensors[${index}]`;
    const { sensor, xM, yM, nominalDeg, ...others } =
      typeof item === 'object' ? own(item as RadarOptions, path) : { sensor: item };
    const [unknown] = Object.keys(others);
    if (unknown !== undefined) {
      throw failure('unknown-option', {
        what: `${path}.${unknown}`,
        expected: 'sensor, xM, yM, nominalDeg',
        given: 'an unknown option',
      });
    }
    return placed(known(view, path, sensor), { ...rest, method: 'recursive', xM, yM, nominalDeg });
  });
  const ids = radars.map(({ sensor }) => sensor);
  const twice = ids.find((id, index) => ids.indexOf(id) !== index);
  if (twice !== undefined)
    throw failure('out-of-range', { what: 'sensors', expected: 'each radar once', given: String(twice) });
  return { radars, joint: true, ...settings({ historyS, maxGapS, weights }) };
}

type RadarOptions = Record<'sensor' | 'xM' | 'yM' | 'nominalDeg', unknown>;

function settings({ historyS, maxGapS, weights }: { historyS?: unknown; maxGapS?: unknown; weights?: unknown }): {
  historyS: number;
  maxGapS: number;
  weights: boolean;
  recorded: false;
} {
  if (weights !== undefined && typeof weights !== 'boolean') throw wrong('weights', 'true or false', weights);
  // No frames follow one another in less than a millisecond.
  return {
    historyS: Math.max(1e-3, positive('historyS', historyS ?? 1)),
    maxGapS: gapOf({ maxGapS: maxGapS as number }),
    weights: weights ?? false,
    recorded: false,
  };
}

function known(view: View, what: string, given: unknown): DriveSensor {
  const radar = view.sensors.find(({ id }) => id === given);
  if (radar) return radar;
  const expected = `a radar of the drive: ${view.sensors.map(({ id }) => id).join(', ') || 'it has none'}`;
  if (given === undefined) throw failure('missing', { what, expected, given: 'nothing' });
  if (typeof given !== 'number') throw wrong(what, expected, given);
  throw failure('out-of-range', { what, expected, given: String(given) });
}

/** Place and nominal angle as asked for, or as the drive has them. */
function placed(
  radar: DriveSensor,
  { xM, yM, nominalDeg, method, ...rest }: { [K in keyof CalibrationOptions]?: unknown },
): Radar {
  const place = xM ?? radar.xM;
  if (place === null) {
    const expected = 'the distance ahead of the rear axle, m, which the drive does not state';
    throw failure('missing', { what: 'xM', expected, given: 'nothing' });
  }
  const nominal = nominalDeg ?? radar.yawDeg;
  // What is not known to be right goes to the calibration, which says what is wrong.
  const options = {
    ...rest,
    method: method ?? 'recursive',
    xM: place,
    yM: yM ?? radar.yM ?? 0,
    ...(nominal !== null && { nominalDeg: nominal }),
  } as CalibrationOptions;
  return { sensor: radar.id, options };
}
