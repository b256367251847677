/**
 * Values with arrays as bytes, and back; python/boresight-widget/boresight_widget/codec.py is the other end.
 *
 * Four bytes with the length of a header (little-endian), the header as JSON, and from the next multiple of eight on the
 * numbers of all arrays. The header is `{ value, arrays }`. In the value `{ "$array": i }` stands for an array,
 * `{ "$records": columns }` for a list of objects given as columns, and `{ "$number": text }` for what JSON has no number for.
 */

const KINDS = {
  i1: Int8Array,
  u1: Uint8Array,
  i2: Int16Array,
  u2: Uint16Array,
  i4: Int32Array,
  u4: Uint32Array,
  f4: Float32Array,
  f8: Float64Array,
} as const;
type Kind = keyof typeof KINDS;
type Numbers = InstanceType<(typeof KINDS)[Kind]>;
type Place = readonly [kind: Kind, start: number, length: number];

const padded = (length: number): number => 8 * Math.ceil(length / 8);

/** The value of bytes. Its arrays are its own and no views of the bytes, which may be part of a larger message. */
export function unpack({ buffer, byteOffset, byteLength }: ArrayBufferView): unknown {
  const header = new DataView(buffer, byteOffset, byteLength).getUint32(0, true);
  const text = new TextDecoder().decode(new Uint8Array(buffer, byteOffset + 4, header));
  const { value, arrays } = JSON.parse(text) as { value: unknown; arrays: Place[] };
  const from = byteOffset + padded(4 + header);
  const made = arrays.map(([kind, start, length]) => {
    const bytes = length * KINDS[kind].BYTES_PER_ELEMENT;
    return new KINDS[kind](buffer.slice(from + start, from + start + bytes) as ArrayBuffer);
  });
  return restored(value, made);
}

function restored(value: unknown, arrays: readonly Numbers[]): unknown {
  if (typeof value !== 'object' || value === null) return value;
  if (Array.isArray(value)) return value.map((item) => restored(item, arrays));
  if ('$array' in value) return arrays[value.$array as number];
  if ('$number' in value) return Number(value.$number);
  if ('$records' in value) return records(restored(value.$records, arrays) as Record<string, ArrayLike<unknown>>);
  return Object.fromEntries(Object.entries(value).map(([key, item]) => [key, restored(item, arrays)]));
}

function records(columns: Record<string, ArrayLike<unknown>>): Record<string, unknown>[] {
  const names = Object.keys(columns);
  const count = columns[names[0] ?? '']?.length ?? 0;
  return Array.from({ length: count }, (_, i) => Object.fromEntries(names.map((name) => [name, columns[name]?.[i]])));
}

/** Whether there are arrays of numbers in a value, which JSON would spell out. */
export function hasArrays(value: unknown): boolean {
  if (typeof value !== 'object' || value === null) return false;
  return ArrayBuffer.isView(value) || Object.values(value).some(hasArrays);
}

/** The bytes of a value. */
export function pack(given: unknown): Uint8Array {
  const arrays: Place[] = [];
  const numbers: Numbers[] = [];
  let size = 0;
  const plain = (value: unknown): unknown => {
    if (typeof value === 'number') return Number.isFinite(value) ? value : { $number: String(value) };
    if (typeof value !== 'object' || value === null) return value;
    if (Array.isArray(value)) return value.map(plain);
    if (!ArrayBuffer.isView(value))
      return Object.fromEntries(Object.entries(value).map(([key, item]) => [key, plain(item)]));
    const array = value as Numbers;
    const kind = (Object.keys(KINDS) as Kind[]).find((name) => array instanceof KINDS[name]);
    if (!kind) throw new TypeError(`${value.constructor.name} has no place among arrays of numbers`);
    numbers.push(array);
    arrays.push([kind, size, array.length]);
    size += padded(array.byteLength);
    return { $array: arrays.length - 1 };
  };
  const value = plain(given);
  const header = new TextEncoder().encode(JSON.stringify({ value, arrays }));
  const from = padded(4 + header.length);
  const bytes = new Uint8Array(from + size);
  new DataView(bytes.buffer).setUint32(0, header.length, true);
  bytes.set(header, 4);
  numbers.forEach(({ buffer, byteOffset, byteLength }, i) => {
    bytes.set(new Uint8Array(buffer, byteOffset, byteLength), from + (arrays[i]?.[1] ?? 0));
  });
  return bytes;
}
