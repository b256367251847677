/** A value and bytes beside it as one piece of bytes: the value as JSON after its length, then each part after its length. */

/** @param {unknown} value @param {...Uint8Array} parts */
export function pack(value, ...parts) {
  const all = [new TextEncoder().encode(JSON.stringify(value)), ...parts];
  const bytes = new Uint8Array(all.reduce((sum, part) => sum + 4 + part.length, 0));
  const view = new DataView(bytes.buffer);
  let at = 0;
  for (const part of all) {
    view.setUint32(at, part.length, true);
    bytes.set(part, at + 4);
    at += 4 + part.length;
  }
  return bytes;
}

/** @param {Uint8Array} bytes @returns {[any, ...Uint8Array<ArrayBuffer>[]]} */
export function unpack(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const parts = [];
  for (let at = 0; at < bytes.length; ) {
    const length = view.getUint32(at, true);
    if (at + 4 + length > bytes.length) throw new RangeError('what was kept is cut short');
    // Copies, so that they can be read as numbers wherever they stood.
    parts.push(new Uint8Array(bytes.subarray(at + 4, at + 4 + length)));
    at += 4 + length;
  }
  const [head, ...rest] = parts;
  return [JSON.parse(new TextDecoder().decode(head)), ...rest];
}
