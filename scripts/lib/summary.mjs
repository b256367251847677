import { stripVTControlCharacters } from 'node:util';

/** Adds up every "test result:" line of cargo, as from `cargo test --workspace`. */
export function cargoCounts(text) {
  const counts = { passed: 0, failed: 0, skipped: 0 };
  for (const [, passed, failed, ignored] of stripVTControlCharacters(text).matchAll(
    /^test result: \S+ (\d+) passed; (\d+) failed; (\d+) ignored/gm,
  )) {
    counts.passed += Number(passed);
    counts.failed += Number(failed);
    counts.skipped += Number(ignored);
  }
  return counts;
}

/** The closing lines of node:test, whichever reporter wrote them. */
export function nodeCounts(text) {
  const last = (name) => {
    const found = [...stripVTControlCharacters(text).matchAll(new RegExp(`^(?:#|ℹ) ${name} (\\d+)$`, 'gm'))];
    return Number(found.at(-1)?.[1] ?? 0);
  };
  return {
    passed: last('pass'),
    failed: last('fail') + last('cancelled'),
    skipped: last('skipped') + last('todo'),
  };
}

/** Names of the page tests that failed once and passed on the second try, which only happens under CI. */
export const passedOnRetry = (text) =>
  [...stripVTControlCharacters(text).matchAll(/^passed on retry: (.+)$/gm)].map(([, name]) => name);

/** A step that is one check: it passed or it failed. */
export const checkCounts = (_text, ok) => ({ passed: ok ? 1 : 0, failed: ok ? 0 : 1, skipped: 0 });

/** Table of steps and the closing line. */
export function summary(results) {
  const width = Math.max(...results.map(({ name }) => name.length), 4);
  const row = (name, cells) => [name.padEnd(width), ...cells.map((cell) => String(cell).padStart(9))].join('');
  const total = (key) => results.reduce((sum, result) => sum + result[key], 0);
  return [
    row('step', ['passed', 'failed', 'skipped', 'seconds']),
    ...results.map((result) =>
      row(result.name, [result.passed, result.failed, result.skipped, result.seconds.toFixed(1)]),
    ),
    '',
    `${total('passed')} passed, ${total('failed')} failed, ${total('skipped')} skipped`,
  ].join('\n');
}
