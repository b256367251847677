/** What a bundler makes of `boresight/worker`: it finds what `new URL(…, import.meta.url)` names, as webpack and Vite do. */
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { consumer } from './consumer.mjs';

let project;
before(async () => {
  project = await consumer({
    tools: ['vite'],
    files: {
      'pool.js': "import { createPool } from 'boresight/worker'; globalThis.pool = createPool();",
      'networks.js': "import 'boresight/neural'; import './pool.js';",
      'bundle.mjs': `
        import { build } from 'vite';
        const [input, assetsInlineLimit] = process.argv.slice(2);
        const { output } = await build({
          configFile: false, logLevel: 'error', worker: { format: 'es' },
          build: { write: false, assetsInlineLimit: Number(assetsInlineLimit), rolldownOptions: { input } },
        });
        const bytes = output.reduce((sum, { code, source }) => sum + (code ?? source).length, 0);
        console.log(JSON.stringify({ files: output.map(({ fileName }) => fileName), bytes }));
      `,
    },
  });
});
after(() => project?.remove());

const bundled = async (...args) => JSON.parse((await project.run(process.execPath, ['bundle.mjs', ...args])).stdout);
const wasm = ({ files }) => files.flatMap((name) => /(\w+)_bg-.*\.wasm$/.exec(name)?.[1] ?? []).sort();

test('a bundle of the pool holds no module of networks', { timeout: 120_000 }, async () => {
  assert.deepEqual(wasm(await bundled('pool.js', '0')), ['boresight', 'boresight_drives']);
  // Two modules of 1.3 MB in base64, and scripts.
  const { bytes } = await bundled('pool.js', '1e9');
  assert.ok(bytes > 3e6 && bytes < 5e6, `${bytes} bytes`);
});

test('with boresight/neural it does, even where nothing of that is named', { timeout: 120_000 }, async () => {
  const found = wasm(await bundled('networks.js', '0'));
  assert.deepEqual(found, ['boresight', 'boresight_drives', 'boresight_neural']);
});
