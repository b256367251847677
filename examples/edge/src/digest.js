/** A 64-bit hash in two words (FNV-1a over 32-bit words), against accidental changes only. */

/** @typedef {[a: number, b: number]} Digest */

/** @type {Digest} */
export const SEED = [0x811c9dc5, 0x9dc5811c];

/** The hash after these words. @param {Digest} digest @param {Uint32Array} words @returns {Digest} */
export function mixed([a, b], words) {
  for (const word of words) {
    a = Math.imul(a ^ word, 0x01000193);
    b = Math.imul(b ^ word ^ (a >>> 15), 0x85ebca6b);
  }
  return [a >>> 0, b >>> 0];
}
