// Uses the package and the built demo for a long time, and says whether their memory stays flat.
// `npm run soak -- --minutes 60`; a third of it goes to a pool of workers in Node (jobs, cancels, traps), a third to the demo
// (pages, seeds, cancels), and a third to a page of elements with live frames, `--hz` a second; nothing may go wrong in them.
// `--only pool`, `--only pages` or `--only elements` runs one of them.
import { existsSync } from 'node:fs';
import { join } from 'node:path';
import { parseArgs } from 'node:util';
import { verdicts } from './lib/build/flat.mjs';
import { root } from './lib/paths.mjs';
import { main } from './lib/run.mjs';
import { soakElements } from './soak/elements.mjs';
import { soakPages } from './soak/pages.mjs';
import { soakPool } from './soak/pool.mjs';

const { values: options } = parseArgs({
  options: {
    minutes: { type: 'string', default: '10' },
    seed: { type: 'string', default: '1' },
    only: { type: 'string' },
    hz: { type: 'string', default: '20' },
  },
});

const PARTS = { pool: soakPool, pages: soakPages, elements: soakElements };
const megabytes = (bytes) => `${(bytes / 1e6).toFixed(1)} MB`;

function show(name, { counts, series, least, problems }) {
  console.log(
    `${name}: ${Object.entries(counts)
      .map(([what, count]) => `${count} ${what}`)
      .join(', ')}`,
  );
  const rows = verdicts(series, { least });
  for (const { name: what, middle, last, share, flat } of rows) {
    const unit = what.endsWith('bytes') ? megabytes : (count) => String(count);
    const change = `${share >= 0 ? '+' : ''}${(100 * share).toFixed(1)} %`;
    console.log(
      `  ${what}: ${unit(middle)} in the middle third, ${unit(last)} in the last (${change}), ${flat ? 'flat' : 'GROWING'}`,
    );
  }
  for (const problem of problems) console.log(`  problem: ${problem}`);
  return problems.length === 0 && rows.every(({ flat }) => flat);
}

await main(async () => {
  const minutes = Number(options.minutes);
  if (!(minutes > 0)) throw new Error(`--minutes is ${options.minutes}; expected a number greater than 0`);
  const names = Object.keys(PARTS).filter((name) => !options.only || name === options.only);
  if (names.length === 0) throw new Error(`--only is ${options.only}; expected ${Object.keys(PARTS).join(', ')}`);
  if (!existsSync(join(root, 'web', 'app', 'dist', 'index.html')))
    throw new Error('nothing is built; run `npm run build` first');
  const good = [];
  for (const name of names) {
    const milliseconds = (60_000 * minutes) / names.length;
    good.push(show(name, await PARTS[name]({ milliseconds, seed: Number(options.seed), hz: Number(options.hz) })));
  }
  if (!good.every(Boolean)) process.exitCode = 1;
});
