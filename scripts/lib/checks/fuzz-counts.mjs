/** Runs of a target and their rate, from the closing lines of libFuzzer; without those, as after a crash, from the last of its progress. */
export function fuzzCounts(text, seconds) {
  const total = text.match(/^stat::number_of_executed_units:\s*(\d+)/m)?.[1];
  const runs = Number(total ?? [...text.matchAll(/^#(\d+)\s/gm)].at(-1)?.[1] ?? 0);
  const rate = text.match(/^stat::average_exec_per_sec:\s*(\d+)/m)?.[1];
  return { runs, rate: Number(rate ?? Math.round(runs / Math.max(seconds, 1))) };
}

/** Table of targets. */
export function fuzzTable(results) {
  const width = Math.max(...results.map(({ name }) => name.length), 6) + 2;
  const row = (name, cells) => [name.padEnd(width), ...cells.map((cell) => String(cell).padStart(12))].join('');
  return [
    row('target', ['runs', 'runs/s', 'corpus', 'crashes']),
    ...results.map(({ name, runs, rate, corpus, crashes }) => row(name, [runs, rate, corpus, crashes])),
  ].join('\n');
}
