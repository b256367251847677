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

/** Most transforms of a message. */
const MOST = 1024;

const text = (of: Fields, name: string): string => (typeof of[name] === 'string' ? (of[name] as string) : '');

function placed(parent: string, child: string, translation: Fields): FramePlace[] {
  const place = { parent, child, xM: numberOf(translation, 'x'), yM: numberOf(translation, 'y') };
  return child && Number.isFinite(place.xM + place.yM) ? [place] : [];
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

/** The places in a message. Throws a `MessageProblem` where it is none. */
export function placesOf(schemaName: string, message: unknown): FramePlace[] {
  const read = KINDS[schemaOf(schemaName)];
  if (!read || !isFields(message)) throw new MessageProblem('malformed', `${schemaName} has no transforms`);
  return read(message);
}
