import assert from 'node:assert/strict';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { skipWithoutBrowser } from '../browser/lib/harness.mjs';
import { launch, openPage, serve } from '../browser/lib/session.mjs';
import { consumer } from './consumer.mjs';

let project;
let browser;
const servers = [];
before(async () => {
  if (skipWithoutBrowser) return;
  project = await consumer({
    tools: ['vite'],
    fixtures: ['program.mjs'],
    files: {
      'index.html':
        '<!doctype html><link rel="icon" href="data:,"><title>consumer</title><main></main><script type="module" src="./page.js"></script>',
      'page.js': `
        import * as boresight from 'boresight';
        import { createPool } from 'boresight/worker';
        import address from 'boresight/models/learned-pursuit.onnx?url';
        import { planeWaveAzimuth, simulatedScans } from './program.mjs';
        await boresight.init();
        const here = await planeWaveAzimuth(boresight, 20);
        const pool = createPool({ workers: 1 });
        const inWorker = await planeWaveAzimuth(pool, -35);
        await boresight.initDrives();
        const scans = [await simulatedScans(boresight), await simulatedScans(pool)];
        const { Network, initNeural } = await import('boresight/neural');
        await initNeural();
        const onnx = new Uint8Array(await (await fetch(address)).arrayBuffer());
        const networks = [new Network(onnx).kind, (await pool.loadNetwork({ onnx })).kind];
        document.querySelector('main').textContent = JSON.stringify([here, inWorker, scans, networks]);
      `,
    },
  });
  browser = await launch();
});
after(async () => {
  await browser?.close();
  for (const server of servers) await server.close();
  project?.remove();
});

async function checkPage(url) {
  const opened = await openPage(browser, url);
  await opened.page
    .waitForFunction(() => document.querySelector('main').textContent !== '', null, { timeout: 20_000 })
    .catch(() => {});
  const text = await opened.page.textContent('main');
  await opened.close();
  assert.deepEqual(opened.problems, []);
  const [here, inWorker, scans, networks] = JSON.parse(text);
  assert.ok(Math.abs(here - 20) < 0.1, `the page found ${here} deg, expected 20`);
  assert.ok(Math.abs(inWorker + 35) < 0.1, `the worker found ${inWorker} deg, expected -35`);
  assert.deepEqual(networks, ['aaetr', 'aaetr']);
  assert.ok(scans[0] > 40 && scans[1] === scans[0], `scans of a simulated second: ${scans}`);
}

test('a Vite project builds with the package and runs in Chromium', {
  skip: skipWithoutBrowser,
  timeout: 120_000,
}, async () => {
  await project.run(process.execPath, [join(project.folder, 'node_modules', 'vite', 'bin', 'vite.js'), 'build']);
  const server = await serve(project.folder);
  servers.push(server);
  await checkPage(server.url);
});

test('the Vite development server serves it too', { skip: skipWithoutBrowser, timeout: 120_000 }, async () => {
  const { createServer } = await import('vite');
  const server = await createServer({
    configFile: false,
    root: project.folder,
    logLevel: 'error',
    server: { host: '127.0.0.1', port: 0 },
  });
  servers.push(server);
  await server.listen();
  const { port } = server.httpServer.address();
  await checkPage(`http://127.0.0.1:${port}/`);
});
