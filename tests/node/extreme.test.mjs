// Extreme finite numbers through every function: an answer or a typed error, never a trap, within the limit of memory.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import * as boresight from 'boresight';
import glue from '../../dist/wasm/boresight.js';
import { generator } from '../../scripts/lib/build/generator.mjs';
import { callBy, goodCalls } from './lib/calls.mjs';
import { spoilers, withExtremes } from './lib/extremes.mjs';

/** Calls in all; `EXTREME_CALLS` asks for more. */
const CALLS = Number(process.env.EXTREME_CALLS ?? 5000);
/** Limits of each call. An instance keeps the memory that it has grown to, so growth beyond its start is bounded by them. */
const LIMITS = { operations: 1e8, bytes: 64 * 2 ** 20 };

const used = async () => (await glue()).memory.buffer.byteLength;
let initial;

before(async () => {
  await Promise.all([boresight.init(), boresight.initDrives()]);
  initial = await used();
});
after(() => boresight.setLimits());

/** Names of the methods that need no network. */
const classical = () =>
  boresight
    .methods()
    .filter(({ network }) => !network)
    .map(({ name }) => name);

/** Every method of `estimate` with the options that its good call has. */
function calls() {
  const good = Object.entries(goodCalls()).filter(([name]) => !['simulateStreet', 'simulateDrive'].includes(name));
  const [input, options] = goodCalls().estimate;
  const estimates = classical().map((method) => [
    'estimate',
    [input, { ...options, method, sources: 1, gridPoints: 32 }],
  ]);
  return [...good, ...estimates, ...estimates];
}

test('a channel 1e-80 below the others ends within the limits', async () => {
  const [elements, snapshots] = [4, 8];
  const data = new Float64Array(2 * elements * snapshots);
  for (let element = 0; element < elements; element++) {
    for (let k = 0; k < snapshots; k++) {
      const size = element === 3 ? 1e-80 : 1;
      data[2 * (element * snapshots + k)] = size * Math.cos(element * 1.1 + k * k * 0.7);
      data[2 * (element * snapshots + k) + 1] = size * Math.sin(element * 2.3 + k * 1.9);
    }
  }
  const input = { snapshots: { data, shape: [elements, snapshots] } };
  for (const method of classical().filter((name) => name !== 'single-snapshot-music')) {
    const counted = ['music', 'root-music', 'esprit', 'min-norm'].includes(method) ? { sources: 1 } : {};
    assert.equal(boresight.estimate(input, { method, array: 'ula4', gridPoints: 64, ...counted }).method, method);
  }
});

test(`${CALLS} calls with extreme finite numbers`, async () => {
  boresight.setLimits(LIMITS);
  const draw = generator(20_261_127);
  const pick = (list) => list[Math.floor(draw() * list.length)];
  const tools = { draw, pick };
  const all = calls();
  const kinds = Object.entries(spoilers);
  const failed = new Map();
  let answered = 0;
  for (let n = 0; n < CALLS; n++) {
    const [name, args] = all[n % all.length];
    const [kind, spoil] = pick(kinds);
    const spoilt = withExtremes(args, spoil, tools);
    if (spoilt === undefined) continue;
    try {
      callBy(name, spoilt);
      answered++;
    } catch (error) {
      if (error instanceof boresight.BoresightError && error.code !== 'trap') continue;
      const key = `${name} ${args[1]?.method ?? ''}, ${kind}: ${error?.code ?? error?.name} ${String(error?.message).slice(0, 120)}`;
      failed.set(key, (failed.get(key) ?? 0) + 1);
      if (error?.code === 'trap') await Promise.all([boresight.init(), boresight.initDrives()]);
    }
  }
  const grown = (await used()) - initial;
  console.log(`${CALLS} calls, ${answered} answered, memory grown by ${Math.round(grown / 2 ** 20)} MiB`);
  assert.deepEqual(Object.fromEntries(failed), {});
  assert.ok(answered > 0.2 * CALLS, `${answered} of ${CALLS} answered`);
  assert.ok(grown <= 2 * LIMITS.bytes, `memory grew by ${grown} bytes`);
});
