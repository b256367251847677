/**
 * How the demo comes over a line of 10 Mbit/s and 40 ms, nothing cached: times are printed, not judged, since they are
 * those of the machine as well. What is sent, and how, is judged.
 */
import assert from 'node:assert/strict';
import { browserTest } from '../lib/harness.mjs';
import { patient } from '../lib/trial.mjs';

const LINE = { offline: false, latency: 40, downloadThroughput: 10e6 / 8, uploadThroughput: 10e6 / 8 };

/** When a page's first useful picture is there, s as asked for, and the most it may fetch until then, bytes. */
const PAGES = [
  { page: 'angle', ready: '[data-row="music"] [data-field="azimuth"][data-value]', asked: 1.8, most: 0.71e6 },
  { page: 'capture', ready: '[data-table="detections"] [data-field="rangeM"][data-value]', asked: 2.5, most: 1.5e6 },
  { page: 'mounting', ready: '[data-row] [data-field="angleDeg"][data-value]', asked: 4, most: 2.3e6 },
  { page: 'birdseye', ready: '[data-row] [data-field="outsideDb"][data-value]', asked: 4, most: 0.84e6 },
  { page: 'networks', ready: '[data-card]', asked: 1.5, most: 0.83e6 },
  {
    page: 'networks',
    query: '?run=1&model=learned-pursuit',
    ready: '[data-table="attempt"] [data-row] [data-field="found"]',
    asked: 6,
    most: 4.4e6,
  },
];

/** In the page: marks when a selector first has an element. */
function noteReady(selector) {
  const watch = new MutationObserver(() => {
    if (!document.querySelector(selector)) return;
    watch.disconnect();
    performance.mark('ready');
  });
  watch.observe(document, { subtree: true, childList: true, attributes: true });
}

const goTo = (page, name) => page.getByRole('navigation', { name: 'Pages' }).getByRole('link', { name }).click();
const pageOf = (name) => PAGES.find(({ page }) => page === name);

for (const { page: name, query = '', ready, asked, most } of PAGES) {
  browserTest(`loading: ${name}${query} over 10 Mbit/s`, { path: '#/networks' }, async ({ browser, url, test }) => {
    // Nothing of the page that the test began with.
    const context = await browser.newContext({ serviceWorkers: 'block' });
    const page = await context.newPage();
    const session = await context.newCDPSession(page);
    await session.send('Network.enable');
    await session.send('Network.emulateNetworkConditions', LINE);
    await page.addInitScript(noteReady, ready);
    const started = performance.now();
    await page.goto(`${url}#/${name}${query}`, { waitUntil: 'commit' });
    await page.waitForSelector(ready, patient);
    const seconds = (performance.now() - started) / 1000;
    const bytes = await page.evaluate(() => {
      // Where the picture takes long to compute, the other pages come before it.
      const until = Math.min(
        ...['ready', 'other pages'].flatMap((name) =>
          performance.getEntriesByName(name).map(({ startTime }) => startTime),
        ),
      );
      return performance
        .getEntriesByType('resource')
        .concat(performance.getEntriesByType('navigation'))
        .filter(({ startTime }) => startTime <= until)
        .reduce((sum, { transferSize }) => sum + transferSize, 0);
    });
    test.diagnostic(
      `loading: ${name}${query}: ${seconds.toFixed(1)} s to the first useful picture (asked ${asked}), ${(bytes / 1e6).toFixed(2)} MB sent`,
    );
    await context.close();
    assert.ok(bytes > 1e5 && bytes < most, `${bytes} bytes`);
  });
}

browserTest(
  'loading: files come compressed, and those with a digest are kept',
  { path: '#/angle' },
  async ({ page, url }) => {
    await page.waitForSelector('[data-row="music"] [data-field="azimuth"][data-value]');
    const names = await page.evaluate(() => performance.getEntriesByType('resource').map(({ name }) => name));
    const assets = names.filter((name) => /\/assets\/.*\.(js|css|wasm)$/.test(name));
    assert.ok(assets.length >= 3);
    for (const name of assets) {
      const response = await page.request.get(name, { headers: { 'Accept-Encoding': 'br, gzip' } });
      assert.match(response.headers()['cache-control'], /immutable/);
      assert.equal(response.headers()['content-encoding'], 'br', name);
      const other = await page.request.get(name, { headers: { 'Accept-Encoding': 'gzip' } });
      assert.equal(other.headers()['content-encoding'], 'gzip', name);
    }
    const index = await page.request.get(url);
    assert.match(index.headers()['cache-control'], /no-cache/);
    assert.equal((await page.request.get(`${url}nothing/here.html`)).status(), 404);
  },
);

browserTest(
  'loading: each module is fetched once, and workers are given it: they start while the line is down',
  { path: '#/networks' },
  async ({ browser, url }) => {
    const context = await browser.newContext({ serviceWorkers: 'block' });
    const asked = [];
    context.on('request', (request) => {
      if (request.url().endsWith('.wasm')) asked.push(request.url().replace(/^.*\/|-[\w-]+\.wasm$/g, ''));
    });
    const page = await context.newPage();
    // The page's first picture comes without workers; cubes are made on the pool.
    await page.goto(`${url}#/angle`);
    await page.waitForSelector(PAGES[0].ready, patient);
    assert.deepEqual(asked, ['boresight_bg']);
    // The line fails for what workers are made of.
    await context.route('**/*.wasm', (route) => route.abort());
    await goTo(page, 'Bird’s-eye view');
    await page.waitForSelector(pageOf('birdseye').ready, patient);
    assert.ok(page.workers().length > 0, 'workers run');
    assert.deepEqual(asked, ['boresight_bg']);
    await context.unroute('**/*.wasm');
    await goTo(page, 'Mounting angle');
    await page.waitForSelector(pageOf('mounting').ready, patient);
    assert.deepEqual(asked, ['boresight_bg', 'boresight_drives_bg']);
    await context.close();
  },
);

/** Opens a page with the core held back until all that is wanted has been asked for; gives all requests until it is ready. */
async function askedWhileHeld(browser, url, { page: name, query = '', ready }, wanted) {
  const context = await browser.newContext({ serviceWorkers: 'block' });
  const page = await context.newPage();
  const asked = [];
  page.on('request', (request) => asked.push(request.url()));
  // What is asked for only after the core never comes.
  let letCome;
  const held = new Promise((resolve) => {
    letCome = resolve;
  });
  await context.route('**/boresight_bg-*.wasm', async (route) => {
    await held;
    await route.continue();
  });
  const all = Promise.all(wanted.map((file) => page.waitForRequest(file, patient)));
  await page.goto(`${url}#/${name}${query}`);
  await all;
  letCome();
  await page.waitForSelector(ready, patient);
  await context.close();
  return asked;
}

browserTest(
  'loading: Mounting asks for its drive and their module beside the core, each once',
  { path: '#/networks' },
  async ({ browser, url }) => {
    const files = [/front_radar/, /pose_10hz/];
    const asked = await askedWhileHeld(browser, url, pageOf('mounting'), [...files, /boresight_drives_bg/]);
    for (const name of files) assert.equal(asked.filter((address) => name.test(address)).length, 1, String(name));
  },
);

browserTest('loading: no step through pages asks for the icon again', { path: '#/angle' }, async ({ page }) => {
  const asked = [];
  page.on('request', (request) => asked.push(request.url()));
  for (const [name, title] of [
    ['networks', 'Networks'],
    ['angle', 'Angle lab'],
  ]) {
    await goTo(page, title);
    await page.waitForSelector(pageOf(name).ready, patient);
    await page.goBack();
    await page.goForward();
  }
  assert.ok(await page.locator('link[rel="icon"][href^="data:image/svg+xml"]').count());
  assert.deepEqual(
    asked.filter((address) => /^http.*icon/.test(address)),
    [],
  );
});

browserTest(
  'loading: Capture and a network’s scene ask for their files beside the core',
  { path: '#/networks' },
  async ({ browser, url }) => {
    for (const [page, wanted] of [
      [pageOf('capture'), [/dca_module/, /visualizer/]],
      [PAGES.at(-1), [/boresight_neural_bg/, /learned-pursuit-[\w-]+\.onnx/]],
    ]) {
      const asked = await askedWhileHeld(browser, url, page, wanted);
      for (const file of wanted) assert.equal(asked.filter((address) => file.test(address)).length, 1, String(file));
    }
  },
);

browserTest(
  'loading: the other pages come when the first is there, and open while the line is down',
  { path: '#/networks' },
  async ({ browser, url }) => {
    const context = await browser.newContext({ serviceWorkers: 'block' });
    const page = await context.newPage();
    await page.goto(`${url}#/angle`);
    await page.waitForSelector(PAGES[0].ready, patient);
    const has = (scripts) =>
      performance.getEntriesByType('resource').filter(({ name }) => /\/page-[\w-]+\.js$/.test(name)).length >= scripts;
    assert.deepEqual([await page.evaluate(has, 1), await page.evaluate(has, 2)], [true, false]);
    await page.waitForFunction(has, 5, patient);
    await context.route('**/*', (route) => route.abort());
    await goTo(page, 'Networks');
    await page.waitForSelector('[data-card]', patient);
    await context.close();
  },
);
