// LZMA as in its specification, with eight bits of the last byte's four high ones as the context of literals: what the
// self-contained builds hold is packed so, as DecompressionStream offers nothing that packs as well in every browser.

/** Bits of the byte before a literal that choose its probabilities; positions choose none. */
export const LITERAL_CONTEXT_BITS = 4;
const LENGTH = 2 + 8 + 8 + 256;

/** Where each kind of decision has its probabilities in one array. */
export const at = {
  isMatch: 0,
  isRep: 12,
  isRepG0: 24,
  isRepG1: 36,
  isRepG2: 48,
  isRep0Long: 60,
  /** Of a distance: four trees of six bits, by length. */
  slot: 72,
  /** The low bits of middle distances. */
  special: 72 + 4 * 64,
  /** The four lowest bits of long ones. */
  align: 72 + 4 * 64 + 128,
  length: 72 + 4 * 64 + 128 + 16,
  repLength: 72 + 4 * 64 + 128 + 16 + LENGTH,
  literal: 72 + 4 * 64 + 128 + 16 + 2 * LENGTH,
  end: 72 + 4 * 64 + 128 + 16 + 2 * LENGTH + (0x300 << LITERAL_CONTEXT_BITS),
} as const;

/** The twelve states, by what came last. */
export const after = {
  literal: (state: number): number => (state < 4 ? 0 : state < 10 ? state - 3 : state - 6),
  match: (state: number): number => (state < 7 ? 7 : 10),
  rep: (state: number): number => (state < 7 ? 8 : 11),
  shortRep: (state: number): number => (state < 7 ? 9 : 11),
};

/** Probabilities before the first decision. */
export const fresh = (): Uint16Array => new Uint16Array(at.end).fill(1024);

/**
 * Fills `out` from a stream without header or end mark. The function it gives goes on until so many bytes stand, and
 * finds an end whatever the stream holds.
 */
export function unpacker(packed: Uint8Array, out: Uint8Array): (until: number) => void {
  const p = fresh();
  let range = 0xffffffff;
  let code = 0;
  let next = 1;
  const byte = (): number => packed[next++] ?? 0;
  for (let k = 0; k < 4; k++) code = ((code << 8) | byte()) >>> 0;

  const normalise = (): void => {
    if (range >= 0x1000000) return;
    range = (range << 8) >>> 0;
    code = ((code << 8) | byte()) >>> 0;
  };
  const bit = (index: number): 0 | 1 => {
    const probability = p[index] as number;
    const bound = (range >>> 11) * probability;
    if (code < bound) {
      range = bound;
      p[index] = probability + ((2048 - probability) >> 5);
      normalise();
      return 0;
    }
    range -= bound;
    code -= bound;
    p[index] = probability - (probability >> 5);
    normalise();
    return 1;
  };
  const tree = (base: number, bits: number): number => {
    let node = 1;
    for (let k = 0; k < bits; k++) node = (node << 1) | bit(base + node);
    return node - (1 << bits);
  };
  const reverseTree = (base: number, bits: number): number => {
    let [node, value] = [1, 0];
    for (let k = 0; k < bits; k++) {
      const one = bit(base + node);
      node = (node << 1) | one;
      value |= one << k;
    }
    return value;
  };
  const direct = (bits: number): number => {
    let value = 0;
    for (let k = 0; k < bits; k++) {
      range >>>= 1;
      const one = code >= range;
      if (one) code -= range;
      value = (value << 1) | Number(one);
      normalise();
    }
    return value;
  };
  const length = (base: number): number => {
    if (bit(base) === 0) return 2 + tree(base + 2, 3);
    if (bit(base + 1) === 0) return 10 + tree(base + 10, 3);
    return 18 + tree(base + 18, 8);
  };
  const distance = (length: number): number => {
    const slot = tree(at.slot + 64 * Math.min(length - 2, 3), 6);
    if (slot < 4) return slot;
    const bits = (slot >> 1) - 1;
    const start = (2 | (slot & 1)) << bits;
    if (slot < 14) return start + reverseTree(at.special + start - slot, bits);
    return start + direct(bits - 4) * 16 + reverseTree(at.align, 4);
  };

  let done = 0;
  let state = 0;
  let [rep0, rep1, rep2, rep3] = [0, 0, 0, 0];
  const literal = (): number => {
    const base = at.literal + 0x300 * ((out[done - 1] ?? 0) >> (8 - LITERAL_CONTEXT_BITS));
    let node = 1;
    if (state >= 7) {
      let match = out[done - rep0 - 1] ?? 0;
      while (node < 0x100) {
        const expected = (match >> 7) & 1;
        match <<= 1;
        const one = bit(base + ((1 + expected) << 8) + node);
        node = (node << 1) | one;
        if (one !== expected) break;
      }
    }
    while (node < 0x100) node = (node << 1) | bit(base + node);
    return node & 0xff;
  };
  const copy = (length: number): void => {
    for (let k = 0; k < length && done < out.length; k++, done++) out[done] = out[done - rep0 - 1] ?? 0;
  };
  /** Brings one of the three distances before the last to the front. */
  const older = (): false => {
    let chosen = rep1;
    if (bit(at.isRepG1 + state) === 1) {
      chosen = rep2;
      if (bit(at.isRepG2 + state) === 1) {
        chosen = rep3;
        rep3 = rep2;
      }
      rep2 = rep1;
    }
    rep1 = rep0;
    rep0 = chosen;
    return false;
  };

  return (until) => {
    while (done < Math.min(until, out.length)) {
      if (bit(at.isMatch + state) === 0) {
        out[done] = literal();
        done += 1;
        state = after.literal(state);
      } else if (bit(at.isRep + state) === 0) {
        [rep3, rep2, rep1] = [rep2, rep1, rep0];
        const count = length(at.length);
        rep0 = distance(count);
        state = after.match(state);
        copy(count);
      } else {
        const short = bit(at.isRepG0 + state) === 1 ? older() : bit(at.isRep0Long + state) === 0;
        const count = short ? 1 : length(at.repLength);
        state = short ? after.shortRep(state) : after.rep(state);
        copy(count);
      }
    }
  };
}
