import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { root } from '../../scripts/lib/paths.mjs';
import { consumer } from './consumer.mjs';

const main = `
  import * as boresight from 'boresight';
  import * as neural from 'boresight/neural';
  import { planeWaveAzimuth, simulatedScans } from './program.mjs';
  import onnx from './network.mjs';
  export default {
    async fetch(request) {
      await boresight.init();
      const azimuthDeg = Number(new URL(request.url).searchParams.get('azimuthDeg'));
      await Promise.all([boresight.initDrives(), neural.initNeural()]);
      const network = new neural.Network(Uint8Array.from(atob(onnx), (c) => c.charCodeAt(0)));
      return Response.json({
        azimuthDeg: await planeWaveAzimuth(boresight, azimuthDeg), scans: await simulatedScans(boresight), network: network.kind,
      });
    },
  };
`;

let project;
let server;
let url;
before(
  async () => {
    const onnx = readFileSync(join(root, 'models', 'learned-pursuit.onnx')).toString('base64');
    const files = { 'main.js': main, 'network.mjs': `export default '${onnx}';` };
    project = await consumer({ tools: ['vite'], fixtures: ['program.mjs'], files });
    // workerd resolves no package names, so a deployment bundles first: with the export map's
    // workerd condition, leaving the wasm as a module of its own, as edge platforms do.
    await project.run(process.execPath, [
      '--input-type=module',
      '--eval',
      `
    import { build } from 'vite';
    import { copyFileSync, mkdirSync } from 'node:fs';
    mkdirSync('bundle', { recursive: true });
    const modules = {
      name: 'wasm-modules', enforce: 'pre',
      async resolveId(source, importer) {
        if (!source.endsWith('.wasm')) return null;
        const found = await this.resolve(source, importer, { skipSelf: true });
        const name = found.id.split(/[\\\\/]/).at(-1);
        copyFileSync(found.id, 'bundle/' + name);
        return { id: './' + name, external: true };
      },
    };
    await build({
      logLevel: 'error', configFile: false, plugins: [modules],
      resolve: { conditions: ['workerd'] },
      ssr: { target: 'webworker', noExternal: true, resolve: { conditions: ['workerd'] } },
      build: { ssr: 'main.js', outDir: 'bundle', emptyOutDir: false, minify: false, rollupOptions: { output: { entryFileNames: 'main.js' } } },
    });
  `,
    ]);
    const names = readdirSync(join(project.folder, 'bundle'));
    const modules = names.map(
      (name) => `(name = "${name}", ${name.endsWith('.wasm') ? 'wasm' : 'esModule'} = embed "bundle/${name}")`,
    );
    modules.sort((a) => (a.includes('"main.js"') ? -1 : 1));
    const config = join(project.folder, 'workerd.capnp');
    writeFileSync(
      config,
      `
    using Workerd = import "/workerd/workerd.capnp";
    const config :Workerd.Config = (
      services = [(name = "main", worker = (compatibilityDate = "2025-01-01", modules = [${modules.join(', ')}]))],
      sockets = [(name = "http", address = "127.0.0.1:0", http = (), service = "main")]
    );
  `,
    );
    url = await start(config);
  },
  { timeout: 120_000 },
);
after(() => {
  server?.kill();
  project?.remove();
});

/** Starts workerd; it says on file descriptor 3 which port it took. */
function start(config) {
  return new Promise((resolve, reject) => {
    const program = join(root, 'node_modules', '.bin', 'workerd');
    server = spawn(program, ['serve', config, '--control-fd=3'], { stdio: ['ignore', 'ignore', 'pipe', 'pipe'] });
    let said = '';
    server.stderr.setEncoding('utf8').on('data', (piece) => (said += piece));
    server.once('error', reject);
    server.once('exit', (code) => reject(new Error(`workerd ended with ${code}\n${said}`)));
    server.stdio[3].once('data', (line) => resolve(`http://127.0.0.1:${JSON.parse(line).port}/`));
  });
}

test('workerd takes the wasm as modules, estimates an angle, simulates a drive and loads a network', async () => {
  for (const expected of [20, -35]) {
    const response = await fetch(`${url}?azimuthDeg=${expected}`);
    const text = await response.text();
    assert.equal(response.status, 200, text);
    const { azimuthDeg, scans, network } = JSON.parse(text);
    assert.equal(network, 'aaetr', 'without a card');
    assert.ok(scans > 40, `${scans} scans of a simulated second`);
    assert.ok(Math.abs(azimuthDeg - expected) < 0.1, `${azimuthDeg} deg should be within 0.1 of ${expected}`);
  }
});
