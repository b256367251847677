/**
 * After how many samples a capture repeats itself. What stands still gives the same samples in each loop of chirps, so
 * samples a loop apart are alike, and two, three, eight loops apart as well; others are not.
 */

/** Two complex samples, as I0 I1 Q0 Q1. */
const GROUP = 4;
/** Shorter repetitions are those of a beat frequency within a chirp. */
const SHORTEST = 16;
/** Longest that is looked for, as of 2048 samples at 4 receivers and 4 transmitters. */
const LONGEST = 16_384;
const PAIRS = 8192;
/** Enough to find candidates, where there are very many. */
const FEW_PAIRS = 256;
/** What is less alike is no loop apart. */
const LEAST_ALIKE = 0.5;
/** So alike nothing is by chance so many times over. */
const ALIKE = 0.9;
const TIMES = 8;

/** Samples of a loop by the data, where they say for certain that it is not the expected one; else null. */
export function otherLoopLength(bin: Uint8Array, expected: { loop: number; chirp: number }): number | null {
  const values = new Int16Array(bin.buffer, bin.byteOffset, Math.floor(bin.byteLength / 2));
  const groups = Math.floor(values.length / GROUP);
  const [mine, chirp] = [expected.loop / 2, expected.chirp / 2];
  if (2 * mine > groups) return null;
  const mean = meanOf(values, groups);
  const alike = (apart: number, pairs: number): Likeness => likeness(values, groups, mean, apart, pairs);
  if (alike(mine, PAIRS).magnitude >= LEAST_ALIKE) return null;
  for (let apart = SHORTEST; apart <= Math.min(LONGEST, groups / (2 * TIMES)); apart++) {
    // Receivers and transmitters see the same targets: their chirps may be alike.
    if (apart < mine && apart % chirp === 0) continue;
    if (alike(apart, FEW_PAIRS).same < ALIKE - 0.1) continue;
    // A few targets that move may be alike once, and are not so again.
    const again = Array.from({ length: TIMES }, (_, i) => alike((i + 1) * apart, PAIRS).same);
    if (again.every((same) => same >= ALIKE)) return 2 * apart;
  }
  return null;
}

interface Complex {
  re: number;
  im: number;
}

/** What the converter adds to all samples is alike at any distance. */
function meanOf(values: Int16Array, groups: number): Complex {
  const step = Math.max(Math.floor(groups / PAIRS), 1) | 1;
  let [re, im, count] = [0, 0, 0];
  for (let group = 0; group < groups; group += step) {
    re += values[GROUP * group] as number;
    im += values[GROUP * group + 2] as number;
    count += 1;
  }
  return { re: re / count, im: im / count };
}

/** Correlation of samples so many groups apart. */
interface Likeness {
  /** 1 where they are the same. */
  same: number;
  /** 1 where they differ by a phase alone. */
  magnitude: number;
}

function likeness(values: Int16Array, groups: number, mean: Complex, apart: number, pairs: number): Likeness {
  const room = groups - apart;
  // An odd step goes through all places of a chirp.
  const step = Math.max(Math.floor(room / pairs), 1) | 1;
  let [re, im, a, b] = [0, 0, 0, 0];
  for (let group = 0; group < room; group += step) {
    const [i, j] = [GROUP * group, GROUP * (group + apart)];
    const xr = (values[i] as number) - mean.re;
    const xi = (values[i + 2] as number) - mean.im;
    const yr = (values[j] as number) - mean.re;
    const yi = (values[j + 2] as number) - mean.im;
    re += xr * yr + xi * yi;
    im += xi * yr - xr * yi;
    a += xr * xr + xi * xi;
    b += yr * yr + yi * yi;
  }
  const scale = Math.sqrt(a * b || 1);
  return { same: re / scale, magnitude: Math.hypot(re, im) / scale };
}
