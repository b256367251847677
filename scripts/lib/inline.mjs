// The package in single files: scripts bundled with what dist/ holds, modules and worker packed inside as text.
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { Worker } from 'node:worker_threads';
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

/**
 * One script of an entry and all it imports, and the licences of what is other people's in it. `archive` is the module that
 * holds the parts that it opens; imports of `boresight` are of what web/inline has of that name.
 */
async function bundled(entry, { format, archive = '', name = 'inline', footer = '' }) {
  const { build } = await import('vite');
  const licences = 'LICENSES.md';
  const [{ output }] = await build({
    configFile: false,
    root,
    logLevel: 'warn',
    plugins: [ofDist, packedParts(archive)],
    resolve: { alias: [{ find: /^boresight$/, replacement: join(sources, 'calibration.ts') }] },
    build: {
      write: false,
      target: 'es2022',
      minify: true,
      license: { fileName: licences },
      lib: { entry, formats: [format], name, fileName: 'inline' },
      rolldownOptions: { output: { codeSplitting: false, minify: true, footer } },
    },
  });
  const chunks = output.filter(({ fileName }) => fileName !== licences);
  if (chunks.length !== 1) throw new Error(`${entry} makes ${chunks.map(({ fileName }) => fileName).join(', ')}`);
  return { code: chunks[0].code, licences: output.find(({ fileName }) => fileName === licences)?.source ?? '' };
}

/** Packs bytes on a thread of its own, as the layout of the library opens them. */
function pack(bytes) {
  const layout = pathToFileURL(join(dist, 'lib', 'runtime', 'lzma.js')).href;
  return new Promise((resolve, reject) => {
    const worker = new Worker(new URL('./lzma-worker.mjs', import.meta.url), { workerData: { bytes, layout } });
    worker.once('message', resolve);
    worker.once('error', reject);
  });
}

/** Parts as a module that holds them: packed one after another, the first opened first. */
async function packedOf(parts) {
  const { compressedBefore, once } = await import('./compressed.mjs');
  const bytes = Buffer.concat(Object.values(parts));
  const packed = await once(compressedBefore, bytes, 'lzma', () => pack(bytes));
  const sizes = Object.fromEntries(Object.entries(parts).map(([name, { length }]) => [name, length]));
  return `export const text = '${Buffer.from(packed).toString('base64')}';\nexport const parts = ${JSON.stringify(sizes)};\n`;
}

const wasm = (name) => readFileSync(join(dist, 'wasm', `${name}_bg.wasm`));
const write = (name, text) => {
  mkdirSync(folder, { recursive: true });
  writeFileSync(join(folder, name), text);
};

/** One script of an entry with the module of drives inside. */
export const bundledWithDrives = async (entry, options) =>
  bundled(entry, { ...options, archive: await packedOf({ drives: wasm('boresight_drives') }) });

/** The package in single files. */
export async function makeInline() {
  const { code: worker } = await bundled(join(dist, 'worker', 'browser-worker.js'), { format: 'iife' });
  write('boresight.worker.js', worker);
  const [archive, networks] = await Promise.all([
    packedOf({ worker: Buffer.from(worker), core: wasm('boresight'), drives: wasm('boresight_drives') }),
    packedOf({ networks: wasm('boresight_neural') }),
  ]);
  for (const [name, format, parts] of [
    ['boresight', 'es', archive],
    ['boresight.global', 'iife', archive],
    ['networks', 'es', networks],
  ])
    write(`${name}.js`, (await bundled(join(sources, `${name}.ts`), { format, archive: parts })).code);
}
