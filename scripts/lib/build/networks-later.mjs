// `npm start` serves the demo before the module of networks is built, which takes minutes: the demo is first built with a
// placeholder, and again when the module is there. Open pages then reload (web/app/networks/module.ts).
import { existsSync, mkdirSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { buildDemo, buildLibrary, buildModule, isBuilt, neural } from '../../build.mjs';
import { dist } from '../paths.mjs';
import { runBehind } from '../run.mjs';

/** Tells vite.config.ts that the demo is built with the placeholder. */
export const withoutNetworks = { BORESIGHT_WITHOUT_NETWORKS: '1' };

/** What the library imports from the bindings of the module. */
const EXPORTS = [
  ...['Network', 'cubeRegions', 'captureRegions', 'jointCubeRegions', 'jointCaptureRegions'],
  ...['initSync', 'lastPanic', 'setLimits', '__wbg_reset_state'],
];
const REASON = 'the module of networks is not built yet';
export const placeholder = {
  '.d.ts': [
    ...EXPORTS.map((name) => `export const ${name}: any;`),
    'export type Network = any;',
    'export default function instantiate(options: any): Promise<any>;\n',
  ].join('\n'),
  '.js': [
    `const missing = () => { throw new Error('${REASON}'); };`,
    ...EXPORTS.map((name) => `export const ${name} = missing;`),
    'export default async () => missing();\n',
  ].join('\n'),
  // A module of WebAssembly with nothing in it.
  '_bg.wasm': Buffer.from([0, 0x61, 0x73, 0x6d, 1, 0, 0, 0]),
};

/** Whether the module is still to be built; the placeholder is then in its place, unless an older build is. */
export function networksMissing() {
  if (isBuilt(neural)) return false;
  mkdirSync(join(dist, 'wasm'), { recursive: true });
  for (const [end, content] of Object.entries(placeholder)) {
    const file = join(dist, 'wasm', neural.name + end);
    if (!existsSync(file)) writeFileSync(file, content);
  }
  return true;
}

/** Builds the module at low priority and then the demo with it; a failure leaves the demo as it is. `dev` builds no demo. */
export async function buildNetworks(dev) {
  const started = Date.now();
  try {
    console.log('start: building the module of networks; the page reloads when it is ready');
    await buildModule(neural, (command, args) => runBehind(command, args, () => {}));
    await buildLibrary();
    if (!dev) await buildDemo();
    console.log(`start: the demo has its networks, after ${((Date.now() - started) / 60_000).toFixed(1)} min`);
  } catch (error) {
    console.error(`start: the module of networks could not be built; the demo continues without\n${error.message}`);
  }
}
