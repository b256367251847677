import { readFile } from 'node:fs/promises';
import { compiled } from './compiled.js';

/** Reads and compiles a module, in Node. */
export const readModule = (address: URL): Promise<WebAssembly.Module> =>
  compiled(address, async () => WebAssembly.compile(await readFile(address)));
