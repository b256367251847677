// A module is compiled once, for this thread and for the workers of all pools.
import assert from 'node:assert/strict';
import { statSync } from 'node:fs';
import { test } from 'node:test';
import { init, initDrives, simulateDrive, version } from 'boresight';
import { createPool } from 'boresight/worker';

test('a module is compiled once for the thread and all pools', async (context) => {
  const { compile } = WebAssembly;
  const sizes = [];
  context.mock.method(WebAssembly, 'compile', (bytes) => {
    sizes.push(bytes.byteLength);
    return compile(bytes);
  });
  const pools = [createPool({ workers: 2 }), createPool({ workers: 1 })];
  const scene = { array: 'ula8', targets: [{ azimuthDeg: 4 }], seed: 1 };
  await Promise.all([init(), initDrives(), ...pools.map((pool) => pool.simulateSnapshots(scene))]);
  for (const pool of pools) {
    const drive = await pool.simulateDrive({ durationS: 2, seed: 1 });
    assert.deepEqual(drive.scans, simulateDrive({ durationS: 2, seed: 1 }).scans);
    pool.terminate();
  }
  assert.match(version(), /^\d/);
  for (const name of ['boresight_bg', 'boresight_drives_bg']) {
    const { size } = statSync(new URL(`../../dist/wasm/${name}.wasm`, import.meta.url));
    // Node compiles modules of its own, too.
    assert.equal(sizes.filter((one) => one === size).length, 1, name);
  }
});
