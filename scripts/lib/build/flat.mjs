// Whether memory stays where it is: the middle third of a run beside its last.

const median = (numbers) => {
  const sorted = [...numbers].sort((a, b) => a - b);
  return sorted.length === 0 ? Number.NaN : sorted[Math.floor(sorted.length / 2)];
};

/**
 * A row for each series of samples: the medians of its middle and its last third, its growth as a share, and whether it
 * is flat. The first third warms up. What grows by less than a series' `least` is noise of small numbers.
 */
export function verdicts(series, { most = 0.1, least = {} } = {}) {
  return Object.entries(series).map(([name, samples]) => {
    const third = Math.floor(samples.length / 3);
    const [middle, last] = [median(samples.slice(third, -third)), median(samples.slice(-third))];
    const share = last === middle ? 0 : last / middle - 1;
    // Too few samples say nothing.
    const flat = third > 0 && (share <= most || last - middle <= (least[name] ?? 0));
    return { name, middle, last, share, flat };
  });
}
