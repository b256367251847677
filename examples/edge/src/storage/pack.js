/**
 * A value with byte arrays as one byte array: a mark, a checksum, then the value as JSON after its length, and each array
 * after its length. Words are little endian. Bytes without the mark were written by versions that had no checksum.
 */
import { mixed, SEED } from '../digest.js';

/** Larger than any length, which is what older versions have here. */
const MARK = 0xb0e51601;
const HEADER = 12;

/** The checksum of all bytes after the header, which starts at a multiple of four. @param {Uint8Array} bytes */
function checksum({ buffer, byteOffset, length }) {
  const count = (length - HEADER) >> 2;
  const tail = new Uint8Array(8);
  tail.set(new Uint8Array(buffer, byteOffset + HEADER + 4 * count, (length - HEADER) & 3));
  tail[4] = length & 3;
  const words = new Uint32Array(buffer, byteOffset + HEADER, count);
  return mixed(mixed(SEED, words), new Uint32Array(tail.buffer));
}

/** @param {unknown} value @param {...Uint8Array} parts */
export function pack(value, ...parts) {
  const all = [new TextEncoder().encode(JSON.stringify(value)), ...parts];
  const bytes = new Uint8Array(all.reduce((sum, part) => sum + 4 + part.length, HEADER));
  const view = new DataView(bytes.buffer);
  let at = HEADER;
  for (const part of all) {
    view.setUint32(at, part.length, true);
    bytes.set(part, at + 4);
    at += 4 + part.length;
  }
  const [a, b] = checksum(bytes);
  view.setUint32(0, MARK, true);
  view.setUint32(4, a, true);
  view.setUint32(8, b, true);
  return bytes;
}

/**
 * What was packed. Throws where the bytes are not those that were written.
 *
 * @param {Uint8Array} given
 * @returns {[any, ...Uint8Array<ArrayBuffer>[]]}
 */
export function unpack(given) {
  const bytes = given.byteOffset % 4 === 0 ? given : given.slice();
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const marked = bytes.length >= HEADER && view.getUint32(0, true) === MARK;
  if (marked) {
    const [a, b] = checksum(bytes);
    if (view.getUint32(4, true) !== a || view.getUint32(8, true) !== b) {
      throw new RangeError(`the checksum of ${bytes.length} bytes does not match`);
    }
  }
  const parts = [];
  for (let at = marked ? HEADER : 0; at < bytes.length; ) {
    const length = at + 4 <= bytes.length ? view.getUint32(at, true) : Number.POSITIVE_INFINITY;
    if (at + 4 + length > bytes.length) throw new RangeError(`${bytes.length} bytes end in the middle of a part`);
    // Copies, because numbers are read at multiples of their size.
    parts.push(new Uint8Array(bytes.subarray(at + 4, at + 4 + length)));
    at += 4 + length;
  }
  const [head, ...rest] = parts;
  if (!head) throw new RangeError('there are no bytes');
  return [JSON.parse(new TextDecoder().decode(head)), ...rest];
}
