// `npm start` builds the package before the module of networks, with a placeholder for its bindings.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { cpSync, mkdirSync, mkdtempSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { placeholder } from '../../scripts/lib/build/networks-later.mjs';
import { root } from '../../scripts/lib/paths.mjs';

test('the package compiles before the module of networks is there', () => {
  const folder = mkdtempSync(join(tmpdir(), 'boresight-later-'));
  try {
    for (const name of ['package.json', 'tsconfig.base.json', 'tsconfig.lib.json', 'web/lib', 'web/worker'])
      cpSync(join(root, name), join(folder, name), { recursive: true });
    symlinkSync(join(root, 'node_modules'), join(folder, 'node_modules'));
    const wasm = join(folder, 'dist/wasm');
    mkdirSync(wasm, { recursive: true });
    for (const name of ['boresight.d.ts', 'boresight_drives.d.ts'])
      cpSync(join(root, 'dist/wasm', name), join(wasm, name));
    writeFileSync(join(wasm, 'boresight_neural.d.ts'), placeholder['.d.ts']);
    const tsc = join(root, 'node_modules/typescript/bin/tsc');
    const said = execFileSync(process.execPath, [tsc, '-p', 'tsconfig.lib.json', '--noEmit'], {
      cwd: folder,
      encoding: 'utf8',
    });
    assert.equal(said.trim(), '');
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
});

test('the placeholder has the exports that its types state, and a valid module', async () => {
  const script = await import(`data:text/javascript,${encodeURIComponent(placeholder['.js'])}`);
  const stated = [...placeholder['.d.ts'].matchAll(/export const (\w+)/g)].map(([, name]) => name);
  assert.deepEqual(Object.keys(script).sort(), [...stated, 'default'].sort());
  await assert.rejects(script.default(), /not built yet/);
  assert.ok(WebAssembly.validate(placeholder['_bg.wasm']));
});
