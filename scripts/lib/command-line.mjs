import { resolve } from 'node:path';
import { root } from './paths.mjs';
import { run } from './run.mjs';

/**
 * Builds `boresight` as tests in Rust do, for the whole workspace, so that what they have compiled serves; its path.
 */
export async function commandLine() {
  await run('cargo', ['build', '--quiet', '--workspace', '--bins', '--profile', 'test']);
  const name = process.platform === 'win32' ? 'boresight.exe' : 'boresight';
  return resolve(root, process.env.CARGO_TARGET_DIR ?? 'target', 'debug', name);
}
