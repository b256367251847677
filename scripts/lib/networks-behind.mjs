// The module of networks, built behind the demo that `npm start` serves; web/networks-later.ts hands it to the page.
import { copyFileSync, existsSync, mkdirSync, renameSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { buildModule, neural } from '../build.mjs';
import { cache, dist } from './paths.mjs';
import { runBehind } from './run.mjs';

const folder = join(cache, 'networks');
const wasm = join(dist, 'wasm');

/** Tells vite.config.ts that the module is to come, and where. */
export const networksLater = { BORESIGHT_NETWORKS: folder };

/** What the library is compiled against until the module has been built once. */
export const types = `
export const Network: any;
export type Network = any;
export const cubeRegions: any;
export const captureRegions: any;
export const jointCubeRegions: any;
export const jointCaptureRegions: any;
export const initSync: any;
export const lastPanic: any;
export const setLimits: any;
export const __wbg_reset_state: any;
export default function instantiate(options: any): Promise<any>;
`;

function say(state) {
  const file = join(folder, 'state.json');
  writeFileSync(`${file}.new`, JSON.stringify(state));
  renameSync(`${file}.new`, file);
}

/** Makes ready for a page that is built before the module. */
export function expectNetworks() {
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
  say({ state: 'waiting' });
  // Types of an older checkout may stand there, without the module.
  const file = (end) => join(wasm, neural.name + end);
  if (!existsSync(file('.js'))) writeFileSync(file('.d.ts'), types);
}

/** What went wrong, in a line. */
export function reasonOf({ message }) {
  const lines = message.split('\n').map((line) => line.trim());
  return lines.find((line) => /^error\b/.test(line)) ?? lines.find((line) => line !== '') ?? 'it is not known why';
}

/** Builds the module at low priority and says how far it is; a failure is said too, and is none of the demo. */
export async function buildNetworks() {
  const started = Date.now();
  const now = (step) => say({ state: 'building', started, step: step.trim() });
  try {
    await buildModule(neural, (command, args) => {
      now(command);
      return runBehind(command, args, now);
    });
    for (const end of ['.js', '_bg.wasm']) copyFileSync(join(wasm, neural.name + end), join(folder, neural.name + end));
    say({ state: 'ready' });
    console.log(`start: the page has its networks, after ${((Date.now() - started) / 60_000).toFixed(1)} min`);
  } catch (error) {
    say({ state: 'failed', reason: reasonOf(error) });
    console.error(`start: the module of networks could not be built; the page goes on without\n${error.message}`);
  }
}
