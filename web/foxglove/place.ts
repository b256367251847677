/** Where a panel's radar is on the car: as its settings say, or as transforms of the data do. */
import type { Immutable, MessageEvent, Subscription, Topic } from '@foxglove/extension';
import { hasPlaces, Places } from '../messages/places.ts';

/** Topics of transforms that are listened to. */
const MOST_TOPICS = 16;

interface Given {
  xM: number | null;
  yM: number | null;
}

export class RadarPlace {
  readonly #places = new Places();
  #frameId = '';

  /** Topics that may say it, as long as the settings do not. */
  wanted({ xM }: Given, topics: readonly Topic[]): Subscription[] {
    if (xM !== null) return [];
    const transforms = topics.filter(({ schemaName }) => hasPlaces(schemaName));
    return transforms.slice(0, MOST_TOPICS).map(({ name }) => ({ topic: name }));
  }

  /** Whether a message was of transforms. */
  take({ schemaName, message }: Immutable<MessageEvent>): boolean {
    if (!hasPlaces(schemaName)) return false;
    this.#places.take(schemaName, message);
    return true;
  }

  /** The frame of the scans. */
  in(frameId: string): void {
    this.#frameId = frameId;
  }

  /** Null where nobody says. */
  of({ xM, yM }: Given): { xM: number; yM: number } | null {
    const told = this.#places.at(this.#frameId);
    const ahead = xM ?? told?.xM;
    return ahead === undefined ? null : { xM: ahead, yM: yM ?? told?.yM ?? 0 };
  }
}
