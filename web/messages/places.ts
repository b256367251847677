/** Where radars are on the car, in messages of transforms. */
import { MessageProblem } from './problem.ts';
import { schemaOf } from './schemas.ts';
import { type Fields, isFields, listOf, numberOf, part } from './values.ts';

/** Where a frame is in another. */
export interface FramePlace {
  parent: string;
  child: string;
  xM: number;
  yM: number;
}

/** Frames that are those of a car; where a radar is in another one, such as that of a kit of sensors, is not its place on the car. */
const CARS = ['car', 'base_link', 'base_footprint', 'ego_vehicle', 'vehicle'];
/** No radar of a car is farther from its rear axle, m. */
const FARTHEST_M = 100;
/** Most frames that are kept. */
const MOST_KEPT = 256;
/** Most transforms of a message. */
const MOST = 1024;

const text = (of: Fields, name: string): string => (typeof of[name] === 'string' ? (of[name] as string) : '');

function placed(parent: string, child: string, translation: Fields): FramePlace[] {
  const place = { parent, child, xM: numberOf(translation, 'x'), yM: numberOf(translation, 'y') };
  return child && Math.max(Math.abs(place.xM), Math.abs(place.yM)) <= FARTHEST_M ? [place] : [];
}

const ofFoxglove = (message: Fields): FramePlace[] =>
  placed(text(message, 'parent_frame_id'), text(message, 'child_frame_id'), part(message, 'translation'));
const ofRos = (message: Fields): FramePlace[] =>
  placed(
    text(part(message, 'header'), 'frame_id'),
    text(message, 'child_frame_id'),
    part(part(message, 'transform'), 'translation'),
  );

const each =
  (name: string, read: (message: Fields) => FramePlace[]) =>
  (message: Fields): FramePlace[] => {
    const list = listOf(message, name);
    if (list.length > MOST)
      throw new MessageProblem('too-large', `${list.length} transforms; at most ${MOST} are expected`);
    return Array.from(list).flatMap((one) => (isFields(one) ? read(one) : []));
  };

const KINDS: Readonly<Record<string, (message: Fields) => FramePlace[]>> = {
  'foxglove.FrameTransform': ofFoxglove,
  'foxglove.FrameTransforms': each('transforms', ofFoxglove),
  'tf2_msgs/TFMessage': each('transforms', ofRos),
};

export const hasPlaces = (schemaName: string): boolean => Object.hasOwn(KINDS, schemaOf(schemaName));

/** The places in a message. */
function placesOf(schemaName: string, message: unknown): FramePlace[] {
  const read = KINDS[schemaOf(schemaName)];
  if (!read || !isFields(message)) throw new MessageProblem('malformed', `${schemaName} has no transforms`);
  return read(message);
}

/** Places on the car that were told, by the names of frames: transforms may come before the first scan, and but once. */
export class Places {
  readonly #places = new Map<string, FramePlace>();

  /** Takes those of a message; whether any is new. Throws a `MessageProblem` where it is none. */
  take(schemaName: string, message: unknown): boolean {
    const news = placesOf(schemaName, message).filter(({ parent, child, xM, yM }) => {
      if (!CARS.includes(parent)) return false;
      const known = this.#places.get(child);
      return known ? known.xM !== xM || known.yM !== yM : this.#places.size < MOST_KEPT;
    });
    for (const one of news) this.#places.set(one.child, one);
    return news.length > 0;
  }

  at(frameId: string): FramePlace | undefined {
    return this.#places.get(frameId);
  }

  clear(): void {
    this.#places.clear();
  }
}
