// The package in single files: scripts bundled with what dist/ holds, modules and worker packed inside as text.
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { pack } from './lzma.mjs';
import { dist, root } from './paths.mjs';

const sources = join(root, 'web', 'inline');
const folder = join(dist, 'inline');

/** Imports out of web/inline are of what the library's build made. */
const ofDist = {
  name: 'of-dist',
  enforce: 'pre',
  resolveId: (name, importer) =>
    importer && dirname(importer) === sources && name.startsWith('../') ? resolve(folder, name) : null,
};

/** What web/inline/archive.ts imports as packed.js. */
const packedParts = (archive) => ({
  name: 'packed',
  enforce: 'pre',
  resolveId: (name) => (name === './packed.js' ? '\0packed' : null),
  load: (id) => (id === '\0packed' ? archive : null),
});

/** One script of an entry and all it imports. */
async function bundled(entry, format, archive = '') {
  const { build } = await import('vite');
  const [{ output }] = await build({
    configFile: false,
    root,
    logLevel: 'warn',
    plugins: [ofDist, packedParts(archive)],
    build: {
      write: false,
      target: 'es2022',
      minify: true,
      lib: { entry, formats: [format], name: 'inline', fileName: 'inline' },
      rolldownOptions: { output: { codeSplitting: false, minify: true } },
    },
  });
  if (output.length !== 1) throw new Error(`${entry} makes ${output.map(({ fileName }) => fileName).join(', ')}`);
  return output[0].code;
}

/** Parts as a module that holds them: packed one after another, the first opened first. */
async function packedOf(parts) {
  const layout = await import(pathToFileURL(join(dist, 'lib', 'runtime', 'lzma.js')));
  const { compressedBefore, once } = await import('./compressed.mjs');
  const bytes = Buffer.concat(Object.values(parts));
  const packed = await once(compressedBefore, bytes, 'lzma', () => pack(bytes, layout));
  const sizes = Object.fromEntries(Object.entries(parts).map(([name, { length }]) => [name, length]));
  return `export const text = '${Buffer.from(packed).toString('base64')}';\nexport const parts = ${JSON.stringify(sizes)};\n`;
}

const wasm = (name) => readFileSync(join(dist, 'wasm', `${name}_bg.wasm`));
const write = (name, text) => {
  mkdirSync(folder, { recursive: true });
  writeFileSync(join(folder, name), text);
};

/** The package in single files. */
export async function makeInline() {
  const worker = await bundled(join(dist, 'worker', 'browser-worker.js'), 'iife');
  write('boresight.worker.js', worker);
  const archive = await packedOf({
    worker: Buffer.from(worker),
    core: wasm('boresight'),
    drives: wasm('boresight_drives'),
  });
  write('boresight.js', await bundled(join(sources, 'boresight.ts'), 'es', archive));
  write('boresight.global.js', await bundled(join(sources, 'boresight.global.ts'), 'iife', archive));
  const networks = await packedOf({ networks: wasm('boresight_neural') });
  write('networks.js', await bundled(join(sources, 'networks.ts'), 'es', networks));
}
