/** The car's motion in messages of several kinds. */
import { MessageProblem } from './problem.ts';
import { stampOf } from './scan.ts';
import { schemaOf } from './schemas.ts';
import { type Fields, isFields, numberOf, within } from './values.ts';

/** The car's motion at a time, as measured. */
export interface MotionSample {
  /** NaN where the message has none. */
  timeS: number;
  /** Positive to the left. */
  yawRateDegps: number;
  /** Forward, of the rear axle; NaN where there is none. */
  speedMps: number;
}

type Motion = Omit<MotionSample, 'timeS'>;

const DEG = 180 / Math.PI;

const twist = (message: Fields): Motion => ({
  yawRateDegps: DEG * numberOf(within(message, 'angular'), 'z'),
  speedMps: numberOf(within(message, 'linear'), 'x'),
});
const velocityReport = (message: Fields): Motion => ({
  yawRateDegps: DEG * numberOf(message, 'heading_rate'),
  speedMps: numberOf(message, 'longitudinal_velocity'),
});

const KINDS: Readonly<Record<string, (message: Fields) => Motion>> = {
  'boresight.CarMotion': (message) => ({
    yawRateDegps: numberOf(message, 'yawRateDegps'),
    speedMps: numberOf(message, 'speedMps'),
  }),
  'foxglove.Odometry': (message) => ({
    yawRateDegps: DEG * numberOf(within(message, 'angular_velocity'), 'z'),
    speedMps: numberOf(within(message, 'linear_velocity'), 'x'),
  }),
  'nav_msgs/Odometry': (message) => twist(within(message, 'twist', 'twist')),
  'geometry_msgs/TwistStamped': (message) => twist(within(message, 'twist')),
  'geometry_msgs/TwistWithCovarianceStamped': (message) => twist(within(message, 'twist', 'twist')),
  'geometry_msgs/Twist': twist,
  'autoware_vehicle_msgs/VelocityReport': velocityReport,
  'autoware_auto_vehicle_msgs/VelocityReport': velocityReport,
  'sensor_msgs/Imu': (message) => ({
    yawRateDegps: DEG * numberOf(within(message, 'angular_velocity'), 'z'),
    speedMps: Number.NaN,
  }),
};

/** The schemas that motion comes in. */
export const MOTION_SCHEMAS = Object.keys(KINDS);

export const hasMotion = (schemaName: string): boolean => Object.hasOwn(KINDS, schemaOf(schemaName));

/** The motion in a message. Throws a `MessageProblem` where there is none. */
export function motionOf(schemaName: string, message: unknown): MotionSample {
  const read = KINDS[schemaOf(schemaName)];
  if (!read || !isFields(message)) throw new MessageProblem('malformed', `${schemaName} has no motion`);
  const motion = read(message);
  if (!Number.isFinite(motion.yawRateDegps)) throw new MessageProblem('no-field', `${schemaName} without a yaw rate`);
  return { timeS: stampOf(message).timeS, ...motion };
}
