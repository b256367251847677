// Lints and format of all Python code (ruff.toml).
import { virtualEnvironment } from './lib/python/python.mjs';
import { main, run } from './lib/run.mjs';

await main(async () => {
  const python = await virtualEnvironment('ruff', 'scripts/ruff-requirements.txt');
  await run(python, ['-m', 'ruff', 'check', '--no-cache']);
  await run(python, ['-m', 'ruff', 'format', '--no-cache', '--check']);
});
