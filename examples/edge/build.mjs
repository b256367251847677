// The page in one module, dist/page.js, and the worker with its modules of WebAssembly, dist/worker.
import { copyFileSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { basename, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';

const here = (name) => fileURLToPath(new URL(name, import.meta.url));
const common = { bundle: true, format: 'esm', target: 'es2022', minify: true, logLevel: 'warning', write: true };

await build({
  ...common,
  entryPoints: [here('page/page.js')],
  outfile: here('dist/page/page.js'),
  external: ['node:*'],
});
const types = { html: 'text/html', js: 'text/javascript', css: 'text/css' };
const files = {
  '/': { type: types.html, text: readFileSync(here('page/index.html'), 'utf8') },
  '/page/page.css': { type: types.css, text: readFileSync(here('page/page.css'), 'utf8') },
  '/page/page.js': { type: types.js, text: readFileSync(here('dist/page/page.js'), 'utf8') },
};
writeFileSync(here('dist/page.js'), `export const files = ${JSON.stringify(files)};\n`);

/** Leaves modules of WebAssembly beside the worker, as its platform takes them. */
const wasmBeside = {
  name: 'wasm-beside',
  setup({ onResolve }) {
    onResolve({ filter: /\.wasm$/ }, ({ path, resolveDir }) => {
      mkdirSync(here('dist/worker'), { recursive: true });
      copyFileSync(join(resolveDir, path), here(`dist/worker/${basename(path)}`));
      return { path: `./${basename(path)}`, external: true };
    });
  },
};
await build({
  ...common,
  entryPoints: [here('src/worker.js')],
  outfile: here('dist/worker/worker.js'),
  conditions: ['workerd', 'worker'],
  external: ['cloudflare:*', 'node:*'],
  plugins: [wasmBeside],
});
