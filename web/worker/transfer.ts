// Moving typed arrays between threads without surprises.

type Bytes = ArrayBufferView<ArrayBufferLike>;

/** The buffers inside a result, each once, so that they move instead of being copied. */
export function buffersOf(value: unknown): ArrayBuffer[] {
  const found = new Set<ArrayBuffer>();
  visit(value, (bytes) => {
    if (bytes.buffer instanceof ArrayBuffer) found.add(bytes.buffer);
  });
  return [...found];
}

function visit(value: unknown, see: (bytes: Bytes) => void): void {
  if (typeof value !== 'object' || value === null) return;
  if (ArrayBuffer.isView(value)) see(value);
  else if (Array.isArray(value)) for (const item of value) visit(item, see);
  else for (const item of Object.values(value)) visit(item, see);
}

/**
 * Arguments ready to be posted, and the buffers to move. A view is copied by itself: cloning it
 * would take the whole buffer it looks at. With `move` views of whole buffers are given away.
 */
export function packed<T>(value: T, move: boolean): { value: T; buffers: ArrayBuffer[] } {
  const buffers = new Set<ArrayBuffer>();
  const pack = (part: unknown): unknown => {
    if (typeof part !== 'object' || part === null) return part;
    if (part instanceof ArrayBuffer) {
      const own = move ? part : part.slice(0);
      buffers.add(own);
      return own;
    }
    if (ArrayBuffer.isView(part)) {
      const whole = part.byteLength === part.buffer.byteLength && part.buffer instanceof ArrayBuffer;
      const own = move && whole ? part : copied(part);
      buffers.add(own.buffer as ArrayBuffer);
      return own;
    }
    if (Array.isArray(part)) return part.map(pack);
    return Object.fromEntries(Object.entries(part).map(([key, item]) => [key, pack(item)]));
  };
  return { value: pack(value) as T, buffers: [...buffers] };
}

function copied(view: Bytes): Bytes {
  if (view instanceof DataView)
    return new DataView(view.buffer.slice(view.byteOffset, view.byteOffset + view.byteLength));
  // The plain kind: a Node Buffer's slice() is a view of the same bytes.
  const kind = kinds.find((kind) => view instanceof kind) ?? Uint8Array;
  return new (kind as typeof Uint8Array)(view as Uint8Array);
}

const kinds = [
  Float64Array,
  Float32Array,
  Uint8Array,
  Uint8ClampedArray,
  Uint16Array,
  Uint32Array,
  Int8Array,
  Int16Array,
  Int32Array,
];
