// The core .wasm is what a page loads before it can do anything: at most 425 KB with Brotli. That of networks, loaded
// when one is asked for, has room for a runtime: at most 3 MB.
import { readFileSync } from 'node:fs';
import { coreWasm, drivesWasm, neuralWasm } from './lib/paths.mjs';
import { main } from './lib/run.mjs';
import { brotliLimit, describeSize, neuralBrotliLimit, overLimit, sizes } from './lib/sizes.mjs';

await main(async () => {
  const given = process.argv[2];
  const modules = given
    ? [['core wasm', given, brotliLimit]]
    : [
        ['core wasm', coreWasm, brotliLimit],
        ['drives wasm, loaded when asked for', drivesWasm, Infinity],
        ['neural wasm, loaded when asked for', neuralWasm, neuralBrotliLimit],
      ];
  const measured = await Promise.all(modules.map(([, file]) => sizes(readFileSync(file))));
  const found = modules.map(([name, , limit], at) => {
    console.log(describeSize(name, measured[at]));
    const problem = overLimit(measured[at], limit);
    return problem && `${name}: ${problem}`;
  });
  const problems = found.filter(Boolean);
  if (problems.length > 0) throw new Error(problems.join('\n'));
});
