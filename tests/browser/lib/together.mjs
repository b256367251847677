/**
 * Test files of pages in one process, which have one browser and one server: to start both takes longer than most of the
 * tests. `half` is 0 or 1: every other file, so that two processes share the work.
 */
import { readdirSync } from 'node:fs';
import { test } from 'node:test';

const FOLDER = new URL('../', import.meta.url);

/** Names of the test files of a half. */
export const filesOf = (half) =>
  readdirSync(FOLDER, { recursive: true })
    .filter((name) => name.endsWith('.test.mjs'))
    .sort()
    .filter((_, at) => at % 2 === half);

export async function together(half) {
  for (const name of filesOf(half)) {
    // A file that cannot be loaded has failed, and takes no other with it.
    await import(new URL(name, FOLDER)).catch((error) =>
      test(`${name} is loaded`, () => {
        throw error;
      }),
    );
  }
}
