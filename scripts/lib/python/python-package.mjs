import { cpSync } from 'node:fs';
import { join } from 'node:path';
import { root } from '../paths.mjs';

/** Folder of the package for Python that has the command line. */
export const source = 'python/boresight';
const files = ['LICENSE', 'LICENSE-APACHE', 'NOTICE', 'models/motion/deepego-plus.bin'];

/** Copies what the package holds of the checkout's root into its folder, since maturin takes nothing from above it. */
export function preparePackage() {
  for (const file of files) cpSync(join(root, file), join(root, source, file));
}
