// The core .wasm is what a page loads before it can do anything; that of networks, loaded when one is asked for, has room
// for a runtime. The self-contained files are what a dashboard holds. scripts/lib/checks/sizes.mjs has the limits.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { foxeName, foxgloveFolder } from './lib/build/foxglove.mjs';
import { notebookFolder } from './lib/build/notebook.mjs';
import {
  coreLimits,
  describeSize,
  foxgloveLimits,
  inlineLimits,
  neuralLimits,
  notebookLimits,
  overLimit,
  sizes,
} from './lib/checks/sizes.mjs';
import { coreWasm, drivesWasm, inlineScript, neuralWasm, root } from './lib/paths.mjs';
import { main } from './lib/run.mjs';

await main(async () => {
  const given = process.argv[2];
  const modules = given
    ? [['core wasm', given, coreLimits]]
    : [
        ['core wasm', coreWasm, coreLimits],
        ['drives wasm, loaded when asked for', drivesWasm, {}],
        ['neural wasm, loaded when asked for', neuralWasm, neuralLimits],
        ['self-contained module', inlineScript('boresight'), inlineLimits],
        ['self-contained classic script', inlineScript('boresight.global'), inlineLimits],
        ['self-contained networks', inlineScript('networks'), {}],
        ["notebooks' module, elements in it", join(root, notebookFolder, 'widget.js'), notebookLimits],
        ['extension for viewers', join(foxgloveFolder, foxeName()), foxgloveLimits],
      ];
  const measured = await Promise.all(modules.map(([, file]) => sizes(readFileSync(file))));
  const found = modules.map(([name, , limits], at) => {
    console.log(describeSize(name, measured[at]));
    const problem = overLimit(measured[at], limits);
    return problem && `${name}: ${problem}`;
  });
  const problems = found.filter(Boolean);
  if (problems.length > 0) throw new Error(problems.join('\n'));
});
