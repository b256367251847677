import { compiled } from '../lib/runtime/compiled.js';
import { part } from './archive.js';

/** A module that this build holds, compiled once. */
export const module = (name: string): Promise<WebAssembly.Module> =>
  compiled(new URL(`boresight:${name}`), async () => WebAssembly.compile(await part(name)));
