// Runs the tests of the experiments and of what writes the pages of results. Training has a command of its own.
import { readdirSync } from 'node:fs';
import { join } from 'node:path';
import { root } from '../../scripts/lib/paths.mjs';
import { main, run } from '../../scripts/lib/run.mjs';

await main(async () => {
  const files = readdirSync(join(root, 'research', 'tests')).filter((name) => name.endsWith('.test.mjs'));
  await run(process.execPath, ['scripts/test-rust.mjs', '--only', 'research/experiments']);
  await run(process.execPath, ['--test', ...files.map((name) => join('research', 'tests', name))]);
  await run(process.execPath, ['research/scripts/tables-of-networks.mjs', '--check']);
});
