// After `npm run build`: `npm test -- [--runtimes node,workerd] [--only kill,hostile,...] [--with JSON]`: what the service is held to, on each runtime.
import { parseArgs } from 'node:util';
import { hostile } from './hostile.mjs';
import { killed } from './kill.mjs';
import { RUNTIMES } from './lib/service.mjs';
import { limits } from './limits.mjs';
import { cpu, load, memory, scrape, startup } from './measure.mjs';

const { values } = parseArgs({
  options: { runtimes: { type: 'string' }, only: { type: 'string' }, with: { type: 'string' } },
});
const parts = { kill: killed, hostile, limits, startup, cpu, memory, load, scrape };
for (const name of values.only?.split(',') ?? Object.keys(parts)) {
  for (const runtime of values.runtimes?.split(',') ?? RUNTIMES) {
    console.log(name, JSON.stringify(await parts[name](runtime, JSON.parse(values.with ?? '{}'))));
  }
}
