import { failure } from './errors.js';

/** Called with the steps done and in all; stops the run by returning `false`. */
// biome-ignore lint/suspicious/noConfusingVoidType: a function that returns nothing is a report too.
export type Report = (done: number, total: number) => boolean | void;

/** Reports, and throws the code `cancelled` where that is the answer; an exception counts as such. */
export function tell(report: Report | undefined, done: number, total: number): void {
  const stop: (cause?: unknown) => never = (cause) => {
    const details = { what: 'steps', expected: String(total), given: `${done}, then a request to stop` };
    throw failure('cancelled', details, cause);
  };
  let answer: ReturnType<Report>;
  try {
    answer = report?.(done, total);
  } catch (thrown) {
    stop(thrown);
  }
  if (answer === false) stop();
}
