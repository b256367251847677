// Writes TypeScript types, JSON Schemas and tables of docs from the descriptions in Rust; with `--check`
// compares them instead. The profile is that of the tests, which hold the files too.
import { main, run } from './lib/run.mjs';

await main(() =>
  run('cargo', ['run', '--quiet', '--profile', 'test', '-p', 'boresight-generate', '--', ...process.argv.slice(2)]),
);
