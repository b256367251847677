// Elements with live frames, for as long as a test may take; `npm run soak -- --only elements --minutes 60` takes an hour.
import assert from 'node:assert/strict';
import { verdicts } from '../../../scripts/lib/build/flat.mjs';
import { soakElements } from '../../../scripts/soak/elements.mjs';
import { retriedTest } from '../lib/harness.mjs';

retriedTest('memory stays flat under 20 frames a second', { timeout: 120_000 }, async () => {
  const { counts, series, least, problems } = await soakElements({ milliseconds: 45_000, hz: 20, sampleMs: 1500 });
  assert.deepEqual(problems, []);
  assert.ok(counts.frames > 450, `${counts.frames} frames`);
  for (const { name, middle, last, flat } of verdicts(series, { least })) {
    assert.ok(flat, `${name}: ${middle} in the middle third, ${last} in the last`);
  }
});
