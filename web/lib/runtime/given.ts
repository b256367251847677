// What callers hand over, read so that objects that lie throw nothing of their own.

const prototype = Object.getPrototypeOf(Int8Array.prototype) as object;

/** What the engine itself says of a typed array, whatever properties it was given; throws for anything else. */
const engine = (name: 'buffer' | 'byteOffset' | 'length'): ((array: object) => unknown) => {
  const get = Object.getOwnPropertyDescriptor(prototype, name)?.get as () => unknown;
  return (array) => get.call(array);
};
const [bufferOf, offsetOf, lengthOf] = [engine('buffer'), engine('byteOffset'), engine('length')] as [
  (array: object) => ArrayBuffer,
  (array: object) => number,
  (array: object) => number,
];

/** Whether this is an array; a proxy of nothing is none. */
export function isArray(value: unknown): value is unknown[] {
  try {
    return Array.isArray(value);
  } catch {
    return false;
  }
}

/** Constructor of a kind of typed arrays. */
export type Kind<T> = new (buffer: ArrayBuffer | number, byteOffset?: number, length?: number) => T;

/** A view of a typed array of one of these kinds that has no properties but its own; undefined for anything else. */
export function typedArray<T>(value: unknown, kinds: readonly Kind<T>[]): T | undefined {
  try {
    const kind = kinds.find((kind) => value instanceof kind);
    if (kind === undefined) return undefined;
    const array = value as object;
    const length = lengthOf(array);
    // A detached one has no buffer to look at.
    return length === 0 ? new kind(0) : new kind(bufferOf(array), offsetOf(array), length);
  } catch {
    return undefined;
  }
}

/** A value in words, short enough for a message. */
export function describe(value: unknown): string {
  if (value === null) return 'null';
  if (typeof value === 'number') return String(value);
  if (!isArray(value)) return typeof value;
  try {
    return `an array of ${Number(value.length)}`;
  } catch {
    return 'an array without a length';
  }
}
