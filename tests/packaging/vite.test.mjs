import assert from 'node:assert/strict';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { skipWithoutBrowser } from '../browser/harness.mjs';
import { launch, openPage, serve } from '../browser/session.mjs';
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
      'index.html': '<!doctype html><link rel="icon" href="data:,"><title>consumer</title><main></main><script type="module" src="./page.js"></script>',
      'page.js': `
        import * as boresight from 'boresight';
        import { planeWaveAzimuth } from './program.mjs';
        await boresight.init();
        document.querySelector('main').textContent = planeWaveAzimuth(boresight, 20);
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

async function azimuthOnPage(url) {
  const opened = await openPage(browser, url);
  await opened.page.waitForFunction(() => document.querySelector('main').textContent !== '', null, { timeout: 20_000 }).catch(() => {});
  const text = await opened.page.textContent('main');
  await opened.close();
  assert.deepEqual(opened.problems, []);
  return text;
}

test('a Vite project builds with the package and runs in Chromium', { skip: skipWithoutBrowser, timeout: 120_000 }, async () => {
  await project.run(process.execPath, [join(project.folder, 'node_modules', 'vite', 'bin', 'vite.js'), 'build']);
  const server = await serve(project.folder);
  servers.push(server);
  const text = await azimuthOnPage(server.url);
  assert.ok(Math.abs(Number(text) - 20) < 0.1, `page shows "${text}", expected 20`);
});
