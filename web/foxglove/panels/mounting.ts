/** The mounting angle of a radar, calibrated in the panel as scans and motion come. */
import type { CalibrationResult } from 'boresight';

import { defineElement } from '../../elements/base/define.ts';
import { MountingAngleElement } from '../../elements/kinds/mounting-angle.ts';
import { Follower } from '../../messages/follow.ts';
import { hasMotion, motionOf } from '../../messages/motion.ts';
import { scanOf } from '../../messages/scan.ts';
import { secondsOf } from '../../messages/values.ts';
import { count } from '../../plots/format.ts';
import type { Panel, View } from '../panel.ts';
import { RadarPlace } from '../place.ts';
import {
  motionTopics,
  placeSettings,
  scanTopics,
  signSettings,
  signsOf,
  subscription,
  timed,
  topicSettings,
} from '../radar-settings.ts';
import { isOpen } from '../runtime.ts';
import { choiceSetting, numberSetting, type ValuesOf } from '../settings.ts';
import { chosen } from '../topics.ts';

const settings = {
  ...topicSettings,
  ...placeSettings,
  ...signSettings,
  from: choiceSetting(
    {
      group: 'Topics',
      label: 'Calibrates',
      help: 'The whole recording is read at once, where the data are files and the application hands them over; live data are taken as they come.',
    },
    { played: 'what is played', whole: 'the whole recording' },
  ),
  toleranceDeg: numberSetting(
    { group: 'Judgement', label: 'Misaligned from (°)', help: 'How far the angle may be off its nominal one.' },
    1,
    { min: 0.01, max: 90, step: 0.1 },
  ),
  sigmas: numberSetting(
    {
      group: 'Judgement',
      label: 'Deviations',
      help: 'How many standard deviations the band shows, and a verdict needs.',
    },
    2,
    { min: 1, max: 5, step: 0.5 },
  ),
};
type Values = ValuesOf<typeof settings>;

export const mountingPanel: Panel<typeof settings> = {
  name: 'Mounting angle',
  settings,
  again: 'Begin anew',
  make(changed) {
    defineElement('boresight-mounting-angle', MountingAngleElement);
    const element = document.createElement('boresight-mounting-angle') as MountingAngleElement;
    let values: Values | null = null;
    let follower: Follower | null = null;
    let made = '';
    let last: CalibrationResult | null = null;
    const radar = new RadarPlace();
    let [scans, motion] = ['', ''];
    const clear = (): void => {
      follower?.free();
      follower = last = null;
      made = '';
      element.history = null;
    };
    const follow = (): void => {
      const place = values && radar.of(values);
      if (!values || !isOpen() || !place) return;
      const { nominalDeg, azimuth, rangeRate } = values;
      const { xM, yM } = place;
      // What the angle depends on: it begins anew where that changes.
      const now = JSON.stringify([xM, yM, nominalDeg, scans, motion, azimuth, rangeRate]);
      if (now === made) return;
      clear();
      made = now;
      follower = new Follower(
        { xM, yM, ...(nominalDeg === null ? {} : { nominalDeg }) },
        {
          angle: (timeS, result) => {
            last = result;
            if (Number.isFinite(result.sigmaDeg)) element.add(timeS, result);
          },
          restarted: () => {
            element.history = null;
          },
        },
      );
    };
    const view: View<typeof settings> = {
      element,
      set(given, topics) {
        values = given;
        const [from, by] = [
          chosen(scanTopics(topics), given.scanTopic),
          chosen(motionTopics(topics), given.motionTopic),
        ];
        [scans, motion] = [from?.name ?? '', by?.name ?? ''];
        const { nominalDeg, toleranceDeg, sigmas } = given;
        if (nominalDeg === null) element.removeAttribute('nominal-deg');
        else element.setAttribute('nominal-deg', String(nominalDeg));
        element.setAttribute('tolerance-deg', String(toleranceDeg));
        element.setAttribute('sigmas', String(sigmas));
        if (!radar.of(given)) clear();
        follow();
        return [...[from, by].flatMap((topic) => (topic ? [subscription(topic)] : [])), ...radar.wanted(given, topics)];
      },
      whole: () => values?.from === 'whole',
      take(event) {
        const { topic, schemaName, message, receiveTime } = event;
        if (!values) return;
        if (radar.take(event)) {
          follow();
          return;
        }
        const receivedS = secondsOf(receiveTime) || 0;
        if (topic === motion && hasMotion(schemaName))
          follower?.addMotion(timed(motionOf(schemaName, message), receivedS));
        else if (topic === scans) {
          const scan = timed(scanOf(schemaName, message, signsOf(values)), receivedS);
          radar.in(scan.frameId);
          follow();
          follower?.addScan(scan);
        }
      },
      clear() {
        clear();
        follow();
        changed();
      },
      said() {
        const wanted = !scans
          ? 'The data have no topic of radar scans (radar_msgs/RadarScan, or a cloud of points with range rates).'
          : !motion
            ? 'The data have no topic of the car’s motion (nav_msgs/Odometry, geometry_msgs/TwistStamped and others).'
            : values && radar.of(values)
              ? null
              : 'No transform says where the radar is: say in the settings how far it is ahead of the rear axle, as its angle depends on that.';
        return { wanted, status: follower ? statusOf(follower, last) : '' };
      },
      remove: clear,
    };
    return view;
  },
};

/** What became of the scans: in the angle as of its last second. */
function statusOf(follower: Follower, last: CalibrationResult | null): string {
  const { scans, motion, late, refused, incomplete, restarts } = follower.counts;
  const frames = last?.frames;
  const parts: [number, string][] = [
    [scans, 'scans'],
    [frames?.used ?? 0, 'used'],
    [frames?.withoutMotion ?? 0, 'without motion'],
    [frames ? frames.standing + frames.slow : 0, 'at a standstill or slow'],
    [frames?.turning ?? 0, 'turning too fast'],
    [frames?.sparse ?? 0, 'with too few detections that stand'],
    [frames?.offSpeed ?? 0, 'off the car’s speed'],
    [late, 'out of order'],
    [refused, 'refused'],
    [incomplete, 'detections without numbers'],
    [restarts, 'times begun anew'],
  ];
  const told = parts.filter(([number], i) => i < 2 || number > 0).map(([number, what]) => `${count(number)} ${what}`);
  return `${told.join(', ')}; ${count(motion)} samples of motion.${follower.problem ? ` ${follower.problem}` : ''}`;
}
