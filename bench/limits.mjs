// `node bench/limits.mjs [--requests NAMES] [--seconds N]`: extreme requests that options allow, each with the operations
// that it says it takes and, where they are few enough to be waited for, its time. Limits are in operations, and what
// they mean in seconds is read here.
import { parseArgs } from 'node:util';
import { init, methods, setLimits, version } from '../dist/lib/node.js';
import { operationsOf, requests } from './extremes.mjs';

const { values } = parseArgs({ options: { requests: { type: 'string' }, seconds: { type: 'string', default: '10' } } });
const longest = Number(values.seconds);
await init();
console.log(`boresight ${version()}, ${methods().length} methods, one thread`);
console.log(`${'request'.padEnd(52)} ${'operations'.padStart(10)} ${'seconds'.padStart(8)} ${'ns each'.padStart(8)}`);

for (const [name, call] of requests()) {
  if (values.requests && !name.includes(values.requests)) continue;
  const line = (...cells) =>
    console.log(`${name.padEnd(52)} ${cells.map((cell) => String(cell).padStart(8)).join(' ')}`);
  const { operations, error } = operationsOf(call);
  if (operations === undefined) {
    line(error.code, error.message);
    continue;
  }
  setLimits({ operations: Number.MAX_VALUE });
  if (operations * 1e-9 > longest) {
    line(operations.toExponential(1).padStart(10), '', '');
    continue;
  }
  const start = performance.now();
  try {
    call();
  } catch (error) {
    line(operations.toExponential(1).padStart(10), error.code);
    continue;
  }
  const seconds = (performance.now() - start) / 1000;
  line(operations.toExponential(1).padStart(10), seconds.toFixed(2), ((seconds * 1e9) / operations).toFixed(2));
}
