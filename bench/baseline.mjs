// Whether ratios of this run have fallen behind those of an earlier one.

/** Spreads below this are taken for this: compilers, caches and clocks differ between machines. */
const LEAST_NOISE = 0.1;
/** How many times the noise a ratio may fall. */
const TIMES = 3;

/** Half the range of the middle four fifths of a ratio, as a natural logarithm. */
const noise = ({ low, high }) => Math.log(high / low) / 2;

/** The ratios worth keeping: both sides ran in one process, without NumPy, whose speed is the machine's. */
export function recorded(rows) {
  const kept = rows.filter(({ ratio, keep, error }) => ratio && keep && !error);
  return Object.fromEntries(kept.map(({ name, ratio: { median, low, high } }) => [name, { median, low, high }]));
}

/**
 * What has become slower against `baseline` beyond three times the noise of either run: lines to print.
 * A row that is there and was not measured is one of them.
 */
export function regressions(rows, baseline) {
  return Object.entries(baseline).flatMap(([name, then]) => {
    const now = rows.find((row) => row.name === name);
    if (!now?.ratio) return [`${name}: ${now?.error ?? 'not measured'}`];
    const limit = TIMES * Math.max(LEAST_NOISE, noise(then), noise(now.ratio));
    const fall = Math.log(then.median / now.ratio.median);
    if (!(fall > limit)) return [];
    const [before, after] = [then.median, now.ratio.median].map((ratio) => `${ratio.toPrecision(3)} x`);
    return [`${name}: ${after}, was ${before}; three times the noise is a factor of ${Math.exp(limit).toPrecision(3)}`];
  });
}
