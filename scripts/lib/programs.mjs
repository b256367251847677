import { resolve } from 'node:path';
import { root } from './paths.mjs';
import { run } from './run.mjs';

/** Builds a program as tests in Rust do, for all crates of the product, so that what they have compiled serves; its path. */
export async function program(name) {
  await run('cargo', ['build', '--quiet', '--bin', name, '--profile', 'test']);
  const exe = process.platform === 'win32' ? '.exe' : '';
  return resolve(root, process.env.CARGO_TARGET_DIR ?? 'target', 'debug', name + exe);
}

let built;
/** The command line for tests: what the environment variable BORESIGHT names, else it is built. */
export function commandLine() {
  built ??= process.env.BORESIGHT ? Promise.resolve(process.env.BORESIGHT) : program('boresight');
  return built;
}
