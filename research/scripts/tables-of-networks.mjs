// Writes the tables of networks on the pages of results from the networks' cards; with `--check` compares them instead.
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { root } from '../../scripts/lib/paths.mjs';
import { main } from '../../scripts/lib/run.mjs';
import { networkDocuments } from './cards.mjs';

await main(async () => {
  const stale = networkDocuments().filter(([name, text]) => readFileSync(join(root, name), 'utf8') !== text);
  if (process.argv.includes('--check') && stale.length > 0)
    throw new Error(`${stale.map(([name]) => name).join(', ')} differ from the cards of the networks`);
  for (const [name, text] of stale) writeFileSync(join(root, name), text);
});
