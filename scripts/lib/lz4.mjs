// Packs into frames of LZ4, for recordings that are made: blocks of 64 KiB, each by itself, the first match there is taken.
const BLOCK = 1 << 16;
const HEAD = Uint8Array.of(0x04, 0x22, 0x4d, 0x18, 0x60, 0x40, 0x82);

/** A block; where it does not get smaller, the bytes as they are. */
function block(bytes) {
  const out = Buffer.alloc(bytes.length + Math.ceil(bytes.length / 255) + 16);
  const places = new Int32Array(1 << 14).fill(-1);
  const word = (at) => bytes[at] | (bytes[at + 1] << 8) | (bytes[at + 2] << 16) | (bytes[at + 3] << 24);
  let [length, from, at] = [0, 0, 0];
  const extended = (count) => {
    for (let left = count - 15; left >= 0; left -= 255) out[length++] = Math.min(left, 255);
  };
  const sequence = (literals, match, distance) => {
    out[length++] = (Math.min(literals, 15) << 4) | Math.min(Math.max(match - 4, 0), 15);
    extended(literals);
    out.set(bytes.subarray(from, from + literals), length);
    length += literals;
    if (match === 0) return;
    out[length++] = distance & 255;
    out[length++] = distance >> 8;
    extended(match - 4);
  };
  // The last match begins 12 bytes before the end at most, and the last 5 bytes are as they are.
  while (at < bytes.length - 12) {
    const now = word(at);
    const slot = Math.imul(now, 2654435761) >>> 18;
    const before = places[slot];
    places[slot] = at;
    if (before < 0 || at - before > 65535 || word(before) !== now) {
      at += 1;
      continue;
    }
    let match = 4;
    while (at + match < bytes.length - 5 && bytes[before + match] === bytes[at + match]) match += 1;
    sequence(at - from, match, at - before);
    at += match;
    from = at;
  }
  sequence(bytes.length - from, 0, 0);
  return length < bytes.length ? out.subarray(0, length) : null;
}

/** A frame without check sums. */
export function lz4(bytes) {
  const parts = [HEAD];
  for (let start = 0; start < bytes.length; start += BLOCK) {
    const plain = bytes.subarray(start, start + BLOCK);
    const packed = block(plain);
    const size = Buffer.alloc(4);
    size.writeUInt32LE(packed ? packed.length : (plain.length | 0x80000000) >>> 0);
    parts.push(size, packed ?? plain);
  }
  parts.push(Buffer.alloc(4));
  return new Uint8Array(Buffer.concat(parts));
}
