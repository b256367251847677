import { createReadStream, existsSync, readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import type { Connect, Plugin } from 'vite';

const standIn = fileURLToPath(new URL('app/networks/stand-in.ts', import.meta.url));
/** What the bindings call themselves in the imports of their module. */
const BINDINGS = './boresight_neural_bg.js';
/** How scripts name the module. */
const ADDRESS = /new URL\('(?:\.\.\/)+(?:dist\/)?wasm\/boresight_neural_bg\.wasm', import\.meta\.url\)/;
const TYPES: Record<string, string> = {
  'state.json': 'application/json',
  'boresight_neural.js': 'text/javascript',
  'boresight_neural_bg.wasm': 'application/wasm',
};

/**
 * For a demo that is up before the module of networks is built: serves the module from a folder, at an address that does
 * not depend on its contents, with the state of its build beside it (scripts/lib/networks-behind.mjs). The demo holds
 * a stand-in for the bindings, which loads them when they are needed (web/app/networks/stand-in.ts).
 */
export function networksLater(folder: string): Plugin {
  const serve: Connect.NextHandleFunction = (request, response, next) => {
    const name = /^\/later\/([\w.]+)(?:\?|$)/.exec(request.url ?? '')?.[1] ?? '';
    const type = TYPES[name];
    if (type === undefined) {
      next();
      return;
    }
    const file = join(folder, name);
    response.setHeader('Cache-Control', 'no-store');
    response.setHeader('Content-Type', type);
    if (existsSync(file)) createReadStream(file).pipe(response);
    else response.writeHead(404).end();
  };
  return {
    name: 'networks-later',
    enforce: 'pre',
    config: () => ({
      resolve: { alias: [{ find: /^(\.\.\/)+wasm\/boresight_neural\.js$/, replacement: standIn }] },
    }),
    transform: {
      filter: { id: /\/networks\/address\.ts$/ },
      handler(code, id) {
        if (!ADDRESS.test(code)) this.error(`${id} no longer has ${ADDRESS}`);
        return code.replace(ADDRESS, "new URL('/later/boresight_neural_bg.wasm', location.href)");
      },
    },
    writeBundle({ dir = '' }) {
      const scripts = readdirSync(join(dir, 'assets')).filter((name) => name.endsWith('.js'));
      const holder = scripts.find((name) => readFileSync(join(dir, 'assets', name), 'utf8').includes(BINDINGS));
      if (holder) this.error(`the demo that comes before the networks holds their bindings, in ${holder}`);
    },
    configureServer: ({ middlewares }) => void middlewares.use(serve),
    configurePreviewServer: ({ middlewares }) => void middlewares.use(serve),
  };
}
