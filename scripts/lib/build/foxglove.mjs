// The extension for Foxglove and Lichtblick: one script, zipped with what the applications read of an extension.
import { mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { dist, root } from '../paths.mjs';
import { bundledWithDrives } from './inline.mjs';

const source = join(root, 'web', 'foxglove');
const text = (...path) => readFileSync(join(root, ...path), 'utf8');

/** The folder that the build fills. */
export const foxgloveFolder = join(dist, 'foxglove');

/** The file to install; its name has the version. */
export const foxeName = () => `boresight-${JSON.parse(text('package.json')).version}.foxe`;

/** Files are dated alike, so that the same sources make the same bytes. */
const DATE = new Date('2024-01-01T00:00:00');

/** What the applications read of an extension. */
function manifest() {
  const { version, description, license, repository } = JSON.parse(text('package.json'));
  return {
    name: 'boresight',
    displayName: 'Boresight',
    description: `${description}: mounting angles, Doppler and conversions of radar messages`,
    publisher: 'boresight',
    homepage: repository.url.replace(/^git\+|\.git$/g, ''),
    version,
    license,
    main: './dist/extension.js',
    keywords: ['radar', 'radar_msgs', 'mounting angle', 'doppler'],
  };
}

export async function makeFoxglove() {
  // A package, which set-up brings after this file is read.
  const { strToU8, zipSync } = await import('fflate');
  // The applications hand over `module`, and no `exports`.
  const { code, licences } = await bundledWithDrives(join(source, 'extension.ts'), {
    format: 'iife',
    name: 'extension',
    footer: 'module.exports = extension;',
  });
  const files = {
    'package.json': `${JSON.stringify(manifest(), null, 2)}\n`,
    'README.md': text('web', 'foxglove', 'README.md'),
    'CHANGELOG.md': text('CHANGELOG.md'),
    'dist/extension.js': code,
    LICENSE: text('LICENSE'),
    'LICENSE-APACHE': text('LICENSE-APACHE'),
    NOTICE: text('NOTICE'),
    'LICENSES.md': licences,
  };
  rmSync(foxgloveFolder, { recursive: true, force: true });
  mkdirSync(foxgloveFolder, { recursive: true });
  const entries = Object.entries(files).map(([name, content]) => [name, strToU8(content)]);
  writeFileSync(join(foxgloveFolder, foxeName()), zipSync(Object.fromEntries(entries), { level: 9, mtime: DATE }));
}
