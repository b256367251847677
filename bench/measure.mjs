// Timing of one thing, or of several things in turn.

export const median = (values) => quantile(values, 0.5);

export function quantile(values, share) {
  const sorted = [...values].sort((a, b) => a - b);
  const at = share * (sorted.length - 1);
  const below = Math.floor(at);
  const above = Math.ceil(at);
  return sorted[below] + (at - below) * (sorted[above] - sorted[below]);
}

const summary = (values) => ({
  best: Math.min(...values),
  median: median(values),
  low: quantile(values, 0.1),
  high: quantile(values, 0.9),
});

/** A side whose work runs here: seconds of that many calls, taking the inputs in turn. */
export function here(run, inputs) {
  return (calls) => {
    const start = process.hrtime.bigint();
    for (let call = 0; call < calls; call++) run(inputs[call % inputs.length]);
    return Number(process.hrtime.bigint() - start) / 1e9;
  };
}

/**
 * Times each side in turn, round after round, in batches of about `batchS` seconds: seconds a call
 * (best, median, 10th and 90th percentile), and for every side but the first the ratio of its time
 * to the first one's, taken round by round. Batches are short, so that most of them run between two
 * interruptions by other processes; rounds are as many as fit into `limitS` seconds, at least 10.
 */
export async function compare(sides, { rounds: most, batchS, warmUpS, limitS }) {
  const calls = [];
  let roundS = 0;
  for (const side of sides) {
    let count = 1;
    let seconds = await side(count);
    // Compilers go by the number of calls, and on a busy machine time says little about that.
    let [spentS, done] = [seconds, count];
    while (seconds < batchS || spentS < warmUpS || (done < 300 && spentS < 10 * warmUpS)) {
      const wanted = Math.ceil((count * batchS) / Math.max(seconds, 1e-7));
      count = Math.max(1, seconds < batchS ? Math.min(wanted, 10 * count) : Math.round((count * batchS) / seconds));
      seconds = await side(count);
      spentS += seconds;
      done += count;
    }
    calls.push(Math.max(1, Math.round((count * batchS) / seconds)));
    roundS += Math.max(batchS, seconds / count);
  }
  const rounds = Math.max(10, Math.min(most, Math.round(limitS / roundS)));
  const times = sides.map(() => []);
  for (let round = 0; round < rounds; round++) {
    for (const [index, side] of sides.entries()) {
      times[index].push((await side(calls[index])) / calls[index]);
    }
  }
  return times.map((own, index) => ({
    seconds: summary(own),
    calls: calls[index] * rounds,
    ...(index > 0 && { ratio: summary(own.map((time, round) => time / times[0][round])) }),
  }));
}
