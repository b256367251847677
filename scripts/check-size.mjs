// The core .wasm is what a page loads before it can do anything: at most 400 KB with Brotli.
import { readFileSync } from 'node:fs';
import { coreWasm, drivesWasm } from './lib/paths.mjs';
import { main } from './lib/run.mjs';
import { describeSize, overLimit, sizes } from './lib/sizes.mjs';

await main(async () => {
  const size = sizes(readFileSync(process.argv[2] ?? coreWasm));
  console.log(describeSize('core wasm', size));
  if (process.argv[2] === undefined) console.log(describeSize('drives wasm, loaded when asked for', sizes(readFileSync(drivesWasm))));
  const problem = overLimit(size);
  if (problem) throw new Error(problem);
});
