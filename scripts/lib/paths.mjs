import { delimiter, join } from 'node:path';
import { fileURLToPath } from 'node:url';

export const root = fileURLToPath(new URL('../../', import.meta.url));
export const tools = join(root, '.tools');
export const toolsBin = join(tools, 'bin');
/** Digests of what is built, and what `npm start` keeps while it runs. */
export const cache = join(root, 'node_modules', '.cache', 'boresight');
export const modulesBin = join(root, 'node_modules', '.bin');
export const wasmTarget = 'wasm32-unknown-unknown';
export const dist = join(root, 'dist');
export const coreWasm = join(dist, 'wasm', 'boresight_bg.wasm');
export const drivesWasm = join(dist, 'wasm', 'boresight_drives_bg.wasm');
export const neuralWasm = join(dist, 'wasm', 'boresight_neural_bg.wasm');
/** A self-contained file. */
export const inlineScript = (name) => join(dist, 'inline', `${name}.js`);

const exe = process.platform === 'win32' ? '.exe' : '';
export const tool = (name) => join(toolsBin, name + exe);

/** Environment in which the checkout's own tools come first. */
export const environment = {
  ...process.env,
  PATH: [toolsBin, modulesBin, process.env.PATH].join(delimiter),
};
