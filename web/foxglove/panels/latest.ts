/** What panels of a single scan have in common: the newest scan, which of it stands, and the car's motion. */
import type { Immutable, MessageEvent, Subscription, Topic } from '@foxglove/extension';
import type { FrameOutcome } from 'boresight';
import { hasMotion, type MotionSample, motionOf } from '../../messages/motion.ts';
import { type Scan, scanOf } from '../../messages/scan.ts';
import { secondsOf } from '../../messages/values.ts';
import { Weigher } from '../../messages/weigh.ts';
import { count } from '../../plots/format.ts';
import type { View } from '../panel.ts';
import { RadarPlace } from '../place.ts';
import { motionTopics, scanTopics, signsOf, subscription, timed } from '../radar-settings.ts';
import type { Settings, ValuesOf } from '../settings.ts';
import { chosen } from '../topics.ts';

/** Motion that is older than this says nothing of a scan. */
const OLDEST_S = 0.5;

export interface LatestScan {
  scan: Scan;
  outcome: FrameOutcome | null;
  /** The car's, at about the time of the scan. */
  motion: MotionSample | null;
}

interface Given {
  scanTopic: string;
  motionTopic: string;
  xM: number | null;
  yM: number | null;
  azimuth: string;
  rangeRate: string;
}

export class Latest {
  readonly #weigher = new Weigher();
  readonly #radar = new RadarPlace();
  #signs = '';
  #motion: MotionSample | null = null;
  #scan: LatestScan | null = null;
  #scans = '';
  #motions = '';

  /** The topics that are wanted. */
  set(given: Given, topics: readonly Topic[]): Subscription[] {
    const { scanTopic, motionTopic } = given;
    const [from, by] = [chosen(scanTopics(topics), scanTopic), chosen(motionTopics(topics), motionTopic)];
    const now = JSON.stringify([from?.name, by?.name, given.azimuth, given.rangeRate]);
    if (now !== this.#signs) this.clear();
    this.#signs = now;
    [this.#scans, this.#motions] = [from?.name ?? '', by?.name ?? ''];
    return [
      ...[from, by].flatMap((topic) => (topic ? [subscription(topic)] : [])),
      ...this.#radar.wanted(given, topics),
    ];
  }

  /** Whether there is something new to show. */
  take(event: Immutable<MessageEvent>, given: Given): boolean {
    const { topic, schemaName, message, receiveTime } = event;
    if (this.#radar.take(event)) return true;
    const receivedS = secondsOf(receiveTime) || 0;
    if (topic === this.#motions && hasMotion(schemaName)) {
      this.#motion = timed(motionOf(schemaName, message), receivedS);
      return false;
    }
    if (topic !== this.#scans) return false;
    const scan = timed(scanOf(schemaName, message, signsOf(given)), receivedS);
    this.#radar.in(scan.frameId);
    const motion = this.#motion && Math.abs(scan.timeS - this.#motion.timeS) <= OLDEST_S ? this.#motion : null;
    this.#scan = { scan, outcome: this.#weigher.weigh(scan), motion };
    return true;
  }

  /** Where the radar is; null where nobody says. */
  place(given: Given): { xM: number; yM: number } | null {
    return this.#radar.of(given);
  }

  get scan(): LatestScan | null {
    return this.#scan;
  }

  clear(): void {
    this.#scan = this.#motion = null;
    this.#weigher.free();
  }

  said(): { status: string; wanted: string | null } {
    const wanted = this.#scans
      ? null
      : 'The data have no topic of radar scans (radar_msgs/RadarScan, or a cloud of points with range rates).';
    if (!this.#scan) return { wanted, status: 'No scan yet.' };
    const { scan, outcome } = this.#scan;
    const left = scan.incomplete ? `, ${count(scan.incomplete)} without numbers left out` : '';
    const still = outcome?.motion ? `, ${count(outcome.motion.inliers)} taken as standing` : '';
    return { wanted, status: `${this.#scans}: ${count(scan.azimuthDeg.length)} detections${still}${left}.` };
  }
}

/**
 * A view of the newest scan. `apply` gives the element what of the settings is its own; `show` draws the scan by them.
 */
export function viewOfLatest<S extends Settings>(
  element: HTMLElement,
  apply: (values: ValuesOf<S> & Given) => void,
  show: (latest: Latest, values: ValuesOf<S> & Given) => void,
): View<S> {
  const latest = new Latest();
  let values: ValuesOf<S> & Given;
  return {
    element,
    set(given, topics) {
      values = given as ValuesOf<S> & Given;
      apply(values);
      const wanted = latest.set(values, topics);
      show(latest, values);
      return wanted;
    },
    take(event) {
      if (latest.take(event, values)) show(latest, values);
    },
    clear() {
      latest.clear();
      show(latest, values);
    },
    said: () => latest.said(),
    remove: () => latest.clear(),
  };
}
