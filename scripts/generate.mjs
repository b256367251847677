// Writes TypeScript types, JSON Schemas and tables of docs from the descriptions in Rust; with `--check`
// compares them instead.
import { program } from './lib/programs.mjs';
import { main, run } from './lib/run.mjs';

await main(async () => run(await program('boresight-generate'), process.argv.slice(2)));
