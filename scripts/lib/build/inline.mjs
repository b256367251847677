// The package in single files: scripts bundled with what dist/ holds, modules and worker packed inside as text.
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { dirname, join, resolve } from 'node:path';
import { dist, root } from '../paths.mjs';

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

/** Parts as a module that holds them: each by gzip, which every browser and runtime opens, in base64. */
async function packedOf(parts) {
  // Needs installed packages, which a build script of a fresh clone has not yet.
  const { gzip } = await import('./compressed.mjs');
  const packed = Object.entries(parts).map(async ([name, bytes]) => [name, (await gzip(bytes)).toString('base64')]);
  return `export const parts = ${JSON.stringify(Object.fromEntries(await Promise.all(packed)))};\n`;
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
