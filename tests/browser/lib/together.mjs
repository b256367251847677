/**
 * Test files of pages in one process, with one browser and one server, which take longer to start than most tests run.
 * `half` is 0 or 1: every other file, so that two processes share the work. BROWSER_SHARD=1/3 takes every third file.
 */
import { readdirSync } from 'node:fs';
import { test } from 'node:test';

const FOLDER = new URL('../', import.meta.url);
const [shard = 1, shards = 1] = (process.env.BROWSER_SHARD || '1/1').split('/').map(Number);

/** Names of the test files of a half. */
export const filesOf = (half) =>
  readdirSync(FOLDER, { recursive: true })
    .filter((name) => name.endsWith('.test.mjs') && !name.startsWith('flows'))
    .sort()
    .filter((_, at) => at % shards === shard - 1)
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
