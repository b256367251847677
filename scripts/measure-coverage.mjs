// Line coverage of each crate by the product's Rust tests (cargo-llvm-cov), and of each folder of the package by its tests
// in Node (c8). Prints a table; pages for each file are in tests/.output/coverage. `--only rust` or `--only node`
// measures one. Instrumented tests are compiled separately and run several times longer.
import { mkdirSync, readdirSync, readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { parseArgs } from 'node:util';
import { buildPackage } from './build.mjs';
import { npmTools } from './lib/build/npm-tools.mjs';
import { cargoTool } from './lib/cargo-tool.mjs';
import { coverageTable, linesByFolder } from './lib/coverage.mjs';
import { root } from './lib/paths.mjs';
import { main, run } from './lib/run.mjs';
import { setup } from './setup.mjs';

const folder = join(root, 'tests', '.output', 'coverage');
const summary = (name) => JSON.parse(readFileSync(join(folder, name), 'utf8'));

async function rust() {
  await run('rustup', ['component', 'add', 'llvm-tools']);
  await cargoTool('cargo-llvm-cov', 'cargo-llvm-cov', '0.9.1');
  await run('cargo', ['llvm-cov', '--no-report', '--quiet']);
  // Programs killed by tests leave truncated profiles.
  const report = ['llvm-cov', 'report', '--failure-mode', 'all'];
  await run('cargo', [...report, '--html', '--output-dir', join(folder, 'rust')]);
  await run('cargo', [...report, '--json', '--summary-only', '--output-path', join(folder, 'rust.json')]);
  const [{ files }] = summary('rust.json').data;
  return linesByFolder(
    files.map(({ filename, summary: { lines } }) => ({ path: filename, lines: lines.count, covered: lines.covered })),
    /\/crates\/(?!wasm)(.+?)\/src\//,
  );
}

async function node() {
  await buildPackage();
  const resolve = await npmTools('c8', { c8: '12.0.0' });
  const program = join(dirname(resolve('c8/package.json')), 'bin', 'c8.js');
  const tests = readdirSync(join(root, 'tests', 'node')).filter((name) => name.endsWith('.test.mjs'));
  await run(process.execPath, [
    program,
    '--all',
    '--include=dist/lib/**/*.js',
    '--include=dist/worker/**/*.js',
    '--reporter=json-summary',
    '--reporter=html',
    `--reports-dir=${join(folder, 'node')}`,
    process.execPath,
    '--test',
    ...tests.map((name) => `tests/node/${name}`),
  ]);
  const { total: _, ...files } = summary('node/coverage-summary.json');
  return linesByFolder(
    Object.entries(files).map(([path, { lines }]) => ({ path, lines: lines.total, covered: lines.covered })),
    /\/dist\/((?:lib|worker)(?:\/[\w-]+(?=\/))?)/,
  );
}

await main(async () => {
  const { values } = parseArgs({ options: { only: { type: 'string' } } });
  const parts = { rust, node };
  if (values.only !== undefined && !parts[values.only]) {
    throw new Error(`no part ${values.only}; there are ${Object.keys(parts).join(', ')}`);
  }
  await setup();
  mkdirSync(folder, { recursive: true });
  for (const [name, measure] of Object.entries(parts)) {
    if (values.only !== undefined && values.only !== name) continue;
    console.log(`\n${coverageTable(name === 'rust' ? 'crate' : 'folder of dist', await measure())}\n`);
  }
  console.log(`Pages for each file: ${folder}`);
});
