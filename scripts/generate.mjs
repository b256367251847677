// Writes TypeScript types, JSON Schemas and tables of docs from the descriptions in Rust, from these the types of
// Python, and the diagram of the crates; with `--check` compares them instead.
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { architecturePage } from './lib/checks/architecture.mjs';
import { root } from './lib/paths.mjs';
import { program } from './lib/programs.mjs';
import { pythonFiles } from './lib/python/python-types.mjs';
import { main, run } from './lib/run.mjs';

await main(async () => {
  const args = process.argv.slice(2);
  await run(await program('boresight-generate'), args);
  const stale = [...pythonFiles(), architecturePage()].filter(
    ([name, text]) => !existsSync(join(root, name)) || readFileSync(join(root, name), 'utf8') !== text,
  );
  if (args.includes('--check') && stale.length > 0)
    throw new Error(
      `${stale.map(([name]) => name).join(', ')} differ from the descriptions in Rust; \`npm run generate\` writes them`,
    );
  for (const [name, text] of stale) writeFileSync(join(root, name), text);
});
