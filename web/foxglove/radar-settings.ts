/** Settings that panels share: topics, signs and place of a radar. */
import type { Subscription, Topic } from '@foxglove/extension';
import { hasMotion, MOTION_SCHEMAS } from '../messages/motion.ts';
import { hasScans, SCAN_SCHEMAS, type Scan, type Signs } from '../messages/scan.ts';
import { schemaOf } from '../messages/schemas.ts';
import { choiceSetting, maybeNumber, topicSetting } from './settings.ts';

const CLOUD = 'foxglove.PointCloud';

/** Topics by how early their schema stands in a list, and of one schema as the data have them. */
function bySchema(topics: readonly Topic[], schemas: readonly string[]): Topic[] {
  const place = ({ schemaName }: Topic): number =>
    (schemas.indexOf(schemaOf(schemaName)) + schemas.length + 1) % (schemas.length + 1);
  return [...topics].sort((a, b) => place(a) - place(b));
}

/** Topics of scans, those last that another extension makes a cloud of. */
export const scanTopics = (topics: readonly Topic[]): Topic[] =>
  bySchema(
    topics.filter(({ schemaName, convertibleTo }) => hasScans(schemaName) || convertibleTo?.includes(CLOUD)),
    SCAN_SCHEMAS,
  );

export const motionTopics = (topics: readonly Topic[]): Topic[] =>
  bySchema(
    topics.filter(({ schemaName }) => hasMotion(schemaName)),
    MOTION_SCHEMAS,
  );

/** What is subscribed to for a topic: scans as the data have them, or as the cloud that is made of them. */
export function subscription(topic: Topic): Subscription {
  const own = hasScans(topic.schemaName) || hasMotion(topic.schemaName);
  return own ? { topic: topic.name } : { topic: topic.name, convertTo: CLOUD };
}

export const topicSettings = {
  scanTopic: topicSetting(
    {
      group: 'Topics',
      label: 'Scans',
      help: 'Detections of one radar in its own frame: radar_msgs/RadarScan, or a cloud of points with range rates.',
    },
    scanTopics,
  ),
  motionTopic: topicSetting(
    {
      group: 'Topics',
      label: 'Motion',
      help: 'Yaw rate and speed of the car: Odometry, TwistStamped, VelocityReport or boresight.CarMotion; Imu for a yaw rate alone.',
    },
    motionTopics,
  ),
};

export const signSettings = {
  azimuth: choiceSetting(
    {
      group: 'Radar',
      label: 'Azimuth is positive',
      help: 'Drivers disagree. The angle of a radar that is mirrored by a wrong sign does not settle, or settles at a wrong value.',
    },
    { left: 'to the left', right: 'to the right' },
  ),
  rangeRate: choiceSetting(
    { group: 'Radar', label: 'Range rate is positive', help: 'Drivers disagree here as well.' },
    { receding: 'when receding', closing: 'when closing' },
  ),
};

export const placeSettings = {
  xM: maybeNumber(
    {
      group: 'Radar',
      label: 'Ahead of rear axle (m)',
      help: 'Where the radar is along the car, negative behind the axle; as transforms of the data say if not given.',
    },
    { min: -100, max: 100, step: 0.1 },
  ),
  yM: maybeNumber(
    {
      group: 'Radar',
      label: 'Left of centre line (m)',
      help: 'Where the radar is across the car; as transforms of the data say, or 0, if not given.',
    },
    { min: -100, max: 100, step: 0.1 },
  ),
  nominalDeg: maybeNumber(
    {
      group: 'Radar',
      label: 'Nominal angle (°)',
      help: 'Where the radar should look, positive to the left. The verdict compares with it.',
    },
    { min: -180, max: 180, step: 0.1 },
  ),
};

export function signsOf({ azimuth, rangeRate }: { azimuth: string; rangeRate: string }): Signs {
  return { azimuth: azimuth === 'right' ? -1 : 1, rangeRate: rangeRate === 'closing' ? -1 : 1 };
}

/** A scan with a time, which is that of its message where it has none of its own. */
export const timed = <T extends Pick<Scan, 'timeS'>>(one: T, receivedS: number): T =>
  Number.isFinite(one.timeS) ? one : { ...one, timeS: receivedS };
