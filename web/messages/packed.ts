/** Numbers of points that are packed one after another: sensor_msgs/PointCloud2 and foxglove.PointCloud. */
import { MessageProblem } from './problem.ts';
import { type Fields, isFields, listOf, numberOf } from './values.ts';

/** Most points that are taken of a cloud. */
export const MOST_POINTS = 65_535;

type Read = (view: DataView, at: number, little: boolean) => number;

const INT8: Read = (view, at) => view.getInt8(at);
const UINT8: Read = (view, at) => view.getUint8(at);
const INT16: Read = (view, at, little) => view.getInt16(at, little);
const UINT16: Read = (view, at, little) => view.getUint16(at, little);
const INT32: Read = (view, at, little) => view.getInt32(at, little);
const UINT32: Read = (view, at, little) => view.getUint32(at, little);
const FLOAT32: Read = (view, at, little) => view.getFloat32(at, little);
const FLOAT64: Read = (view, at, little) => view.getFloat64(at, little);

/** Kinds of numbers by their codes, 1 to 8: `datatype` of sensor_msgs/PointField. */
const POINT_FIELD = [INT8, UINT8, INT16, UINT16, INT32, UINT32, FLOAT32, FLOAT64];
/** `type` of foxglove.PackedElementField. */
const PACKED_ELEMENT = [UINT8, INT8, UINT16, INT16, UINT32, INT32, FLOAT32, FLOAT64];
const BYTES = new Map<Read, number>([
  [INT8, 1],
  [UINT8, 1],
  [INT16, 2],
  [UINT16, 2],
  [INT32, 4],
  [UINT32, 4],
  [FLOAT32, 4],
  [FLOAT64, 8],
]);

/** The columns of a cloud by the names of its fields. */
export interface Columns {
  count: number;
  /** The first of these names that there is; undefined where there is none. */
  column(...names: readonly string[]): Float64Array | undefined;
}

/** The columns of a sensor_msgs/PointCloud2. */
export function pointCloud2(message: Fields): Columns {
  const stride = numberOf(message, 'point_step');
  const places = numberOf(message, 'width') * numberOf(message, 'height');
  return columns(message, { stride, places, codes: POINT_FIELD, code: 'datatype', big: message.is_bigendian === true });
}

/** The columns of a foxglove.PointCloud, whose bytes are base64 in JSON. */
export function foxgloveCloud(message: Fields): Columns {
  const stride = numberOf(message, 'point_stride');
  return columns(message, {
    stride,
    places: Number.POSITIVE_INFINITY,
    codes: PACKED_ELEMENT,
    code: 'type',
    big: false,
  });
}

interface Layout {
  stride: number;
  places: number;
  codes: readonly Read[];
  /** The field that holds the code. */
  code: string;
  big: boolean;
}

function columns(message: Fields, { stride, places, codes, code, big }: Layout): Columns {
  const bytes = bytesOf(message.data);
  if (!(Number.isInteger(stride) && stride > 0))
    throw new MessageProblem('malformed', `a whole number of bytes a point is expected, ${stride} is given`);
  const count = Math.min(Math.floor(bytes.length / stride), Number.isFinite(places) ? places : bytes.length);
  if (count > MOST_POINTS)
    throw new MessageProblem('too-large', `a cloud has ${count} points; at most ${MOST_POINTS} are expected`);
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const fields = new Map<unknown, Fields>();
  for (const field of Array.from(listOf(message, 'fields'))) if (isFields(field)) fields.set(field.name, field);
  return {
    count,
    column(...names) {
      const name = names.find((one) => fields.has(one));
      const field = fields.get(name);
      if (!field) return undefined;
      const offset = numberOf(field, 'offset');
      const read = codes[numberOf(field, code) - 1];
      if (!read || !(Number.isInteger(offset) && offset >= 0 && offset + (BYTES.get(read) ?? 0) <= stride))
        throw new MessageProblem('malformed', `the field ${name} lies outside its point or has no kind of number`);
      return Float64Array.from({ length: count }, (_, i) => read(view, i * stride + offset, !big));
    },
  };
}

function bytesOf(data: unknown): Uint8Array {
  if (data instanceof Uint8Array) return data;
  if (ArrayBuffer.isView(data)) return new Uint8Array(data.buffer, data.byteOffset, data.byteLength);
  if (typeof data === 'string') {
    try {
      return Uint8Array.from(atob(data), (character) => character.charCodeAt(0));
    } catch {
      throw new MessageProblem('malformed', 'the bytes of a cloud are no base64');
    }
  }
  if (Array.isArray(data)) return Uint8Array.from(data, (byte) => (typeof byte === 'number' ? byte : 0));
  throw new MessageProblem('malformed', 'a cloud without bytes');
}
