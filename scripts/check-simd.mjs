// The core .wasm must hold SIMD instructions in its function bodies, not only declare the feature.
import { readFileSync } from 'node:fs';
import { vectorInstructions } from './lib/checks/wasm-simd.mjs';
import { coreWasm } from './lib/paths.mjs';
import { main } from './lib/run.mjs';

await main(async () => {
  const counts = await vectorInstructions(readFileSync(process.argv[2] ?? coreWasm));
  const rows = [...counts].sort(([, a], [, b]) => b - a);
  const total = rows.reduce((sum, [, count]) => sum + count, 0);
  const arithmetic = rows.filter(([name]) => /^f(32x4|64x2)\.(add|sub|mul)$/.test(name));
  console.log(
    `${total} SIMD instructions, ${rows.length} kinds; most: ${rows
      .slice(0, 6)
      .map((row) => row.join(' '))
      .join(', ')}`,
  );
  if (arithmetic.length === 0) {
    throw new Error('no floating-point SIMD arithmetic in the module: is +simd128 set in .cargo/config.toml?');
  }
});
