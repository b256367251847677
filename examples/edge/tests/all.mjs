// After `npm run build`: `npm test -- [--runtimes node,workerd] [--only kill,hostile,...]`: what the service is held to, on each runtime.
import { parseArgs } from 'node:util';
import { hostile } from './hostile.mjs';
import { killed } from './kill.mjs';
import { RUNTIMES } from './lib/service.mjs';

const { values } = parseArgs({ options: { runtimes: { type: 'string' }, only: { type: 'string' } } });
const parts = { kill: killed, hostile };
for (const name of values.only?.split(',') ?? Object.keys(parts)) {
  for (const runtime of values.runtimes?.split(',') ?? RUNTIMES) {
    console.log(name, JSON.stringify(await parts[name](runtime)));
  }
}
