// The site without its server: what the service worker keeps, how a new release comes, what the viewer is told.
import assert from 'node:assert/strict';
import {
  linkSync,
  mkdirSync,
  mkdtempSync,
  readdirSync,
  readFileSync,
  renameSync,
  rmSync,
  writeFileSync,
} from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after } from 'node:test';
import { setTimeout } from 'node:timers/promises';
import { serveFolder } from '../../../scripts/lib/build/compressed.mjs';
import { freePort } from '../../../scripts/lib/free-port.mjs';
import { root } from '../../../scripts/lib/paths.mjs';
import { reload } from '../lib/demo.mjs';
import { browserTest } from '../lib/harness.mjs';
import { pages } from '../lib/pages.mjs';
import { patient } from '../lib/trial.mjs';

const built = join(root, 'web', 'app', 'dist');
const folder = mkdtempSync(join(tmpdir(), 'boresight-offline-'));
const opened = [];
after(async () => {
  for (const server of opened) {
    server.closeAllConnections();
    server.close();
  }
  rmSync(folder, { recursive: true });
});

/** A site of its own, whose files and presence a test changes. */
async function site() {
  const asked = [];
  let answer = serveFolder(built);
  const server = createServer((request, response) => {
    asked.push(request.url);
    if (answer === null) request.socket.destroy();
    else
      answer(request, response, () => {
        response.statusCode = 404;
        response.end();
      });
  });
  const port = await freePort();
  await new Promise((resolve) => server.listen(port, '127.0.0.1', resolve));
  opened.push(server);
  return {
    url: `http://127.0.0.1:${port}/`,
    asked,
    /** Nobody answers any more. */
    goDown: () => {
      answer = null;
      server.closeAllConnections();
    },
    release: (from) => {
      answer = serveFolder(from);
    },
  };
}

/** The built site as its next release: its main script has another name, and the old one is gone. */
function nextRelease() {
  const next = join(folder, 'next');
  mkdirSync(join(next, 'assets'), { recursive: true });
  for (const name of readdirSync(join(built, 'assets')))
    linkSync(join(built, 'assets', name), join(next, 'assets', name));
  const index = readFileSync(join(built, 'index.html'), 'utf8');
  const main = /assets\/(index-[\w-]+)\.js/.exec(index)[1];
  for (const ending of ['.br', '.gz']) rmSync(join(next, 'assets', `${main}.js${ending}`));
  renameSync(join(next, 'assets', `${main}.js`), join(next, 'assets', 'index-ofNextRelease.js'));
  writeFileSync(join(next, 'index.html'), index.replaceAll(main, 'index-ofNextRelease'));
  const worker = readFileSync(join(built, 'service-worker.js'), 'utf8');
  const changed = worker.replaceAll(main, 'index-ofNextRelease').replace(/(`index\.html`,revision:`)\w+/, '$1next');
  assert.ok(changed.includes('index-ofNextRelease') && changed.includes('revision:`next`'));
  writeFileSync(join(next, 'service-worker.js'), changed);
  return next;
}

const mainScript = (page) => page.evaluate(() => document.querySelector('script[type="module"][src]').src);
const contentsOfCaches = (page) =>
  page.evaluate(async () => {
    const names = await caches.keys();
    const lists = await Promise.all(
      names.map(async (name) => (await (await caches.open(name)).keys()).map(({ url }) => url)),
    );
    return lists.flat().map((url) => new URL(url).pathname);
  });

/** Waits until the page is kept, and its worker serves it. */
async function whenKept(page) {
  await page.waitForFunction(() => navigator.serviceWorker.controller?.state === 'activated', null, patient);
}

/** Waits until one of a list matches. */
async function whenAmong(list, pattern, what) {
  for (let tries = 0; tries < 200; tries++) {
    if ((await list()).some((path) => pattern.test(path))) return;
    await setTimeout(100);
  }
  assert.fail(`nothing like ${pattern} is ${what}: ${(await list()).join(' ')}`);
}

const whenHeld = (page, pattern) => whenAmong(() => contentsOfCaches(page), pattern, 'kept');
const whenAsked = (pattern) => whenAmong(() => own.asked, pattern, 'asked for');

/** Waits until the scripts of all pages are there: they begin to come when the site begins to be kept. */
const whenComplete = (page) =>
  page.waitForFunction(
    (count) => {
      const names = performance.getEntriesByType('resource').map(({ name }) => name);
      return new Set(names.filter((name) => /\/page-[\w-]+\.js$/.test(name))).size === count;
    },
    pages.length,
    patient,
  );

const offlineUse = (page) => page.getByText('Offline use', { exact: true });
const keepSite = (page) => page.getByRole('checkbox', { name: /^Keep the site for offline use/ });

/** What fails while nobody answers is no problem of the page. */
function forgive(problems) {
  const left = problems.filter(
    (text) => !/ERR_(ABORTED|FAILED|INTERNET_DISCONNECTED|EMPTY_RESPONSE|CONNECTION_\w+)/.test(text),
  );
  problems.splice(0, problems.length, ...left);
}

let own;
const served = async () => {
  own = await site();
  return own;
};
const options = { served, serviceWorkers: 'allow', timeout: 180_000 };

browserTest(
  'offline: after the first visit every page gives its results without the server',
  { ...options, path: '#/mounting' },
  async ({ page, context, problems, url }) => {
    await page.waitForSelector(pages.find(({ path }) => path === '#/mounting').ready, patient);
    await whenKept(page);
    await whenHeld(page, /front_radar/);
    own.goDown();
    await context.setOffline(true);
    for (const { path, ready } of pages) {
      await page.goto(`${url}${path}`);
      await reload(page);
      await page.waitForSelector(ready, patient);
    }
    forgive(problems);
  },
);

browserTest(
  'offline: a network that was used once runs without the server, and what was not used is not fetched beforehand',
  { ...options, path: '#/networks?run=1&model=dnn-small-1' },
  async ({ page, problems }) => {
    const result = '[data-attempt] [data-row]';
    await page.waitForSelector(result, patient);
    await whenKept(page);
    await whenHeld(page, /dnn-small-1-.*onnx$/);
    await whenHeld(page, /neural.*wasm$/);
    const held = await contentsOfCaches(page);
    assert.equal(held.filter((path) => path.endsWith('.onnx')).length, 1, held.join(' '));
    own.goDown();
    await reload(page);
    await page.waitForSelector(result, patient);
    forgive(problems);
  },
);

browserTest(
  'offline: a second visit asks the server for nothing but the page and its worker',
  { ...options, path: '#/angle' },
  async ({ page }) => {
    await page.waitForSelector(pages[0].ready, patient);
    await whenKept(page);
    own.asked.length = 0;
    await reload(page);
    await page.waitForSelector(pages[0].ready, patient);
    await whenAsked(/^\/service-worker\.js$/);
    await whenComplete(page);
    assert.deepEqual([...new Set(own.asked)].sort(), ['/', '/service-worker.js']);
  },
);

browserTest(
  'offline: a new release is told to an open page, starts on request, and leaves nothing of the old one',
  { ...options, path: '#/angle' },
  async ({ page, context, problems, url }) => {
    await page.waitForSelector(pages[0].ready, patient);
    await whenKept(page);
    const before = await mainScript(page);
    own.release(nextRelease());
    assert.equal((await page.request.get(before)).status(), 404);
    await page.evaluate(async () => (await navigator.serviceWorker.getRegistration()).update());
    const notice = page.locator('[data-notice="release"]');
    await notice.waitFor(patient);
    assert.equal(await mainScript(page), before, 'the page goes on until it is asked');
    own.asked.length = 0;
    await notice.getByRole('button', { name: 'Reload' }).click();
    await page.waitForFunction(() => document.querySelector('script[src*="ofNextRelease"]'), null, patient);
    await page.waitForSelector(pages[0].ready, patient);
    await whenKept(page);
    // The page looks for a newer release, and finds none to tell.
    await whenAsked(/^\/service-worker\.js$/);
    await whenComplete(page);
    const held = await contentsOfCaches(page);
    assert.equal(await notice.count(), 0);
    assert.ok(held.some((path) => path.includes('ofNextRelease')));
    assert.ok(!held.includes(new URL(before).pathname), 'the old script is no longer kept');
    own.goDown();
    await context.setOffline(true);
    await page.goto(`${url}#/capture`);
    await reload(page);
    await page.waitForSelector(pages[1].ready, patient);
    assert.match(await mainScript(page), /ofNextRelease/);
    forgive(problems);
  },
);

browserTest(
  'offline: the footer says what is kept, and removes it for good',
  { ...options, path: '#/angle' },
  async ({ page }) => {
    await page.waitForSelector(pages[0].ready, patient);
    await whenKept(page);
    await offlineUse(page).click();
    await page.waitForSelector('[data-kept]');
    const bytes = Number(await page.locator('[data-kept]').getAttribute('data-kept'));
    assert.ok(bytes > 3e6, `${bytes} bytes`);
    assert.match(
      await page.locator('[data-kept]').innerText(),
      /pages, signal processing and examples: \d+ files, [\d.]+ MiB/,
    );
    await keepSite(page).click();
    await page.waitForSelector('[data-kept="0"]');
    assert.deepEqual(await contentsOfCaches(page), []);
    await reload(page);
    await page.waitForSelector(pages[0].ready, patient);
    await whenComplete(page);
    assert.deepEqual(await contentsOfCaches(page), []);
    assert.equal(await page.evaluate(async () => (await navigator.serviceWorker.getRegistrations()).length), 0);
    await offlineUse(page).click();
    await keepSite(page).click();
    await reload(page);
    await whenHeld(page, /index\.html$/);
  },
);

browserTest(
  'offline: a browser that refuses to keep anything shows the site as ever',
  options,
  async ({ context, url }) => {
    const page = await context.newPage();
    await page.addInitScript(() => {
      const refuse = () => Promise.reject(new DOMException('The operation is insecure.', 'SecurityError'));
      ServiceWorkerContainer.prototype.register = refuse;
      for (const name of ['keys', 'open', 'match', 'has', 'delete']) CacheStorage.prototype[name] = refuse;
      Object.defineProperty(window, 'localStorage', {
        get() {
          throw new DOMException('The operation is insecure.', 'SecurityError');
        },
      });
    });
    await page.goto(`${url}#/angle`);
    await page.waitForSelector(pages[0].ready, patient);
    await whenComplete(page);
    await offlineUse(page).click();
    await page.waitForSelector('[data-kept="0"]');
    await page.close();
  },
);
