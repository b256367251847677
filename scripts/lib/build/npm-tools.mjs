import { existsSync, readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { tools } from '../paths.mjs';
import { run } from '../run.mjs';

/**
 * Installs npm packages of exactly these versions into a folder of `.tools`, for whoever needs them: beside those of the project, which
 * everybody has. Gives a function from names to where they are.
 */
export async function npmTools(folder, versions) {
  const at = join(tools, folder);
  const stands = ([name, version]) => {
    const manifest = join(at, 'node_modules', name, 'package.json');
    return existsSync(manifest) && JSON.parse(readFileSync(manifest, 'utf8')).version === version;
  };
  const wanted = Object.entries(versions);
  if (!wanted.every(stands)) {
    const names = wanted.map(([name, version]) => `${name}@${version}`);
    console.log(`setup: ${names.join(', ')} into .tools`);
    await run('npm', ['install', '--prefix', at, '--no-save', '--no-audit', '--no-fund', ...names]);
  }
  return createRequire(join(at, 'index.js')).resolve;
}
