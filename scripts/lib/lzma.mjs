// Packs bytes as web/lib/runtime/lzma.ts opens them. Which matches are taken is worked out backwards over stretches, by what
// each would cost with the probabilities that stand at the stretch's start.

/** Bytes whose best path is found at a time. */
const STRETCH = 4096;
const LONGEST = 273;
/** A match this long is taken without a look at what else there is. */
const ENOUGH = 128;
/** Candidates tried for a match. */
const DEPTH = 48;

const HASH_BITS = 17;
/** Bits that a decision costs, by its probability in 2048 parts. */
const cost = Float64Array.from({ length: 2049 }, (_, p) => -Math.log2(Math.max(p, 1) / 2048));

/** Gives, position by position, matches of growing length, each at its least distance. */
function finder(bytes) {
  const heads = new Int32Array(1 << HASH_BITS).fill(-1);
  const pairs = new Int32Array(1 << 16).fill(-1);
  const previous = new Int32Array(bytes.length);
  const lengthAt = (from, to, most) => {
    let length = 0;
    while (length < most && bytes[from + length] === bytes[to + length]) length++;
    return length;
  };
  return (at) => {
    const found = [];
    const most = Math.min(LONGEST, bytes.length - at);
    if (most < 2) return found;
    const pair = bytes[at] | (bytes[at + 1] << 8);
    const near = pairs[pair];
    pairs[pair] = at;
    let best = 1;
    if (near >= 0) {
      best = lengthAt(near, at, most);
      found.push({ length: best, distance: at - near - 1 });
    }
    if (most < 3) return found;
    const hash = Math.imul(pair | (bytes[at + 2] << 16), 0x9e3779b1) >>> (32 - HASH_BITS);
    let candidate = heads[hash];
    previous[at] = candidate;
    heads[hash] = at;
    for (let tried = 0; tried < DEPTH && candidate >= 0 && best < most; tried++, candidate = previous[candidate]) {
      if (bytes[candidate + best] !== bytes[at + best]) continue;
      const length = lengthAt(candidate, at, most);
      if (length <= best) continue;
      best = length;
      found.push({ length, distance: at - candidate - 1 });
    }
    return found;
  };
}

/** The range coder: decisions into bytes. */
function coder(p) {
  const out = [];
  let [low, range, cache, pending] = [0, 0xffffffff, 0, 1];
  const shift = () => {
    if (low < 0xff000000 || low > 0xffffffff) {
      const carry = low > 0xffffffff ? 1 : 0;
      for (; pending > 0; pending--, cache = 0xff) out.push((cache + carry) & 0xff);
      cache = Math.floor(low / 0x1000000) & 0xff;
    }
    pending++;
    low = (low % 0x1000000) * 256;
  };
  const normalise = () => {
    while (range < 0x1000000) {
      range = (range << 8) >>> 0;
      shift();
    }
  };
  return {
    bit(index, one) {
      const probability = p[index];
      const bound = (range >>> 11) * probability;
      if (one) {
        low += bound;
        range -= bound;
        p[index] = probability - (probability >> 5);
      } else {
        range = bound;
        p[index] = probability + ((2048 - probability) >> 5);
      }
      normalise();
    },
    direct(value, bits) {
      for (let k = bits - 1; k >= 0; k--) {
        range >>>= 1;
        if ((value >> k) & 1) low += range;
        normalise();
      }
    },
    end() {
      for (let k = 0; k < 5; k++) shift();
      return Uint8Array.from(out);
    },
  };
}

/** How symbols are made of decisions; `bit(index, one)` takes each. */
function symbols(layout, bytes, bit, direct) {
  const { at, LITERAL_CONTEXT_BITS } = layout;
  const tree = (base, value, bits) => {
    for (let k = bits - 1, node = 1; k >= 0; k--) {
      const one = (value >> k) & 1;
      bit(base + node, one);
      node = (node << 1) | one;
    }
  };
  const reverseTree = (base, value, bits) => {
    for (let k = 0, node = 1; k < bits; k++) {
      const one = (value >> k) & 1;
      bit(base + node, one);
      node = (node << 1) | one;
    }
  };
  return {
    literal(position, state, rep0) {
      const base = at.literal + 0x300 * ((bytes[position - 1] ?? 0) >> (8 - LITERAL_CONTEXT_BITS));
      const value = bytes[position];
      let match = state >= 7 ? bytes[position - rep0 - 1] : -1;
      for (let k = 7, node = 1; k >= 0; k--) {
        const one = (value >> k) & 1;
        if (match < 0) bit(base + node, one);
        else {
          const expected = (match >> k) & 1;
          bit(base + ((1 + expected) << 8) + node, one);
          if (one !== expected) match = -1;
        }
        node = (node << 1) | one;
      }
    },
    length(base, length) {
      bit(base, length >= 10 ? 1 : 0);
      if (length < 10) {
        tree(base + 2, length - 2, 3);
        return;
      }
      bit(base + 1, length >= 18 ? 1 : 0);
      if (length < 18) tree(base + 10, length - 10, 3);
      else tree(base + 18, length - 18, 8);
    },
    distance(length, distance) {
      const slot = slotOf(distance);
      tree(at.slot + 64 * Math.min(length - 2, 3), slot, 6);
      if (slot < 4) return;
      const bits = (slot >> 1) - 1;
      const start = (2 | (slot & 1)) << bits;
      if (slot < 14) {
        reverseTree(at.special + start - slot, distance - start, bits);
        return;
      }
      direct((distance - start) >>> 4, bits - 4);
      reverseTree(at.align, distance & 15, 4);
    },
  };
}

function slotOf(distance) {
  if (distance < 4) return distance;
  const bits = 31 - Math.clz32(distance);
  return bits * 2 + ((distance >> (bits - 1)) & 1);
}

/** Decisions that choose one of the last four distances. */
const REPS = [
  [
    ['isRepG0', 0],
    ['isRep0Long', 1],
  ],
  [
    ['isRepG0', 1],
    ['isRepG1', 0],
  ],
  [
    ['isRepG0', 1],
    ['isRepG1', 1],
    ['isRepG2', 0],
  ],
  [
    ['isRepG0', 1],
    ['isRepG1', 1],
    ['isRepG2', 1],
  ],
];
const toFront = (reps, k) => [reps[k], ...reps.filter((_, index) => index !== k)];

/** `layout` is what web/lib/runtime/lzma.ts exports. */
export function pack(bytes, layout) {
  const { at, after, fresh } = layout;
  const p = fresh();
  const out = coder(p);
  const write = symbols(layout, bytes, out.bit, out.direct);
  let price = 0;
  const priced = symbols(
    layout,
    bytes,
    (index, one) => {
      price += cost[one ? 2048 - p[index] : p[index]];
    },
    (_, bits) => {
      price += bits;
    },
  );
  const costOf = (work) => {
    price = 0;
    work();
    return price;
  };
  const flag = (name, state, one) => cost[one ? 2048 - p[at[name] + state] : p[at[name] + state]];
  const matchesAt = finder(bytes);

  let state = 0;
  let reps = [0, 0, 0, 0];

  /** What stands from a position on, at its least cost: nodes that point at what came before. */
  function path(first, last) {
    const lengths = [at.length, at.repLength].map((base) =>
      Float64Array.from({ length: LONGEST + 1 }, (_, length) =>
        length < 2 ? 0 : costOf(() => priced.length(base, length)),
      ),
    );
    const distances = new Map();
    const distanceCost = (length, distance) => {
      // The align bits of long ones differ little.
      const key = (distance < 128 ? distance : 128 + slotOf(distance)) * 4 + Math.min(length - 2, 3);
      let known = distances.get(key);
      if (known === undefined) {
        known = costOf(() => priced.distance(length, distance));
        distances.set(key, known);
      }
      return known;
    };
    const nodes = Array.from({ length: last - first + 1 }, () => ({ price: Infinity }));
    nodes[0] = { price: 0, state, reps };
    const offer = (from, length, total, kind, rep, distance) => {
      const to = nodes[from + length];
      if (total >= to.price) return;
      to.price = total;
      to.from = from;
      to.kind = kind;
      to.rep = rep;
      to.distance = distance;
    };
    for (let index = 0; index < last - first; index++) {
      const position = first + index;
      const node = nodes[index];
      if (node.from !== undefined) settle(nodes, node, after);
      const most = Math.min(LONGEST, last - position);
      const [now, recent] = [node.state, node.reps];
      const matches = matchesAt(position);
      const match = node.price + flag('isMatch', now, 1);
      const rep = match + flag('isRep', now, 1);
      const plain = node.price + flag('isMatch', now, 0);
      offer(index, 1, plain + costOf(() => priced.literal(position, now, recent[0])), 'literal');
      if (position > recent[0] && bytes[position] === bytes[position - recent[0] - 1])
        offer(index, 1, rep + flag('isRepG0', now, 0) + flag('isRep0Long', now, 0), 'short');
      for (let k = 0; k < 4; k++) {
        const from = position - recent[k] - 1;
        if (from < 0) continue;
        let length = 0;
        while (length < most && bytes[from + length] === bytes[position + length]) length++;
        if (length < 2) continue;
        const chosen = REPS[k].reduce((sum, [name, one]) => sum + flag(name, now, one), rep);
        for (let n = length >= ENOUGH ? length : 2; n <= length; n++) offer(index, n, chosen + lengths[1][n], 'rep', k);
      }
      const plainMatch = match + flag('isRep', now, 0);
      let n = 2;
      for (const { length, distance } of matches) {
        const end = Math.min(length, most);
        if (end >= ENOUGH) n = end;
        for (; n <= end; n++)
          offer(index, n, plainMatch + lengths[0][n] + distanceCost(n, distance), 'match', 0, distance);
      }
    }
    const steps = [];
    for (let index = last - first; index > 0; index = nodes[index].from)
      steps.push({ ...nodes[index], length: index - nodes[index].from });
    return steps.reverse();
  }

  const say = (name, one) => out.bit(at[name] + state, one);
  for (let position = 0; position < bytes.length; ) {
    for (const { kind, rep, distance, length } of path(position, Math.min(position + STRETCH, bytes.length))) {
      say('isMatch', kind === 'literal' ? 0 : 1);
      if (kind !== 'literal') say('isRep', kind === 'match' ? 0 : 1);
      if (kind === 'literal') {
        write.literal(position, state, reps[0]);
        state = after.literal(state);
      } else if (kind === 'match') {
        write.length(at.length, length);
        write.distance(length, distance);
        reps = [distance, ...reps.slice(0, 3)];
        state = after.match(state);
      } else if (kind === 'short') {
        say('isRepG0', 0);
        say('isRep0Long', 0);
        state = after.shortRep(state);
      } else {
        for (const [name, one] of REPS[rep]) say(name, one);
        write.length(at.repLength, length);
        reps = toFront(reps, rep);
        state = after.rep(state);
      }
      position += length;
    }
  }
  return out.end();
}

/** State and last distances of a node, by the step that leads to it. */
function settle(nodes, node, after) {
  const { state, reps } = nodes[node.from];
  if (node.kind === 'literal') [node.state, node.reps] = [after.literal(state), reps];
  else if (node.kind === 'short') [node.state, node.reps] = [after.shortRep(state), reps];
  else if (node.kind === 'rep') [node.state, node.reps] = [after.rep(state), toFront(reps, node.rep)];
  else [node.state, node.reps] = [after.match(state), [node.distance, ...reps.slice(0, 3)]];
}
