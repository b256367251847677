/** Serving a built site and opening its pages in headless Chromium. */
import { mkdirSync } from 'node:fs';
import { join } from 'node:path';
import { browserArguments, browserMissing, findBrowser } from '../../../scripts/lib/browser.mjs';
import { compressed } from '../../../scripts/lib/build/compressed.mjs';
import { root } from '../../../scripts/lib/paths.mjs';

export const viewports = {
  desktop: { width: 1280, height: 800 },
  phone: { width: 390, height: 844 },
};
export const schemes = ['light', 'dark'];
export const outputFolder = join(root, 'tests', '.output');

/** Serves a built site on a free port of this machine. */
export async function serve(siteRoot = join(root, 'web', 'app'), options = {}) {
  const { preview } = await import('vite');
  const server = await preview({
    configFile: false,
    root: siteRoot,
    logLevel: 'error',
    appType: 'mpa',
    plugins: [compressed()],
    preview: { host: '127.0.0.1', port: 0, open: false },
    ...options,
  });
  const { port } = server.httpServer.address();
  return { url: `http://127.0.0.1:${port}/`, close: () => server.close() };
}

/** Starts Chromium with an empty profile of its own. */
export async function launch() {
  const executablePath = findBrowser();
  if (!executablePath) throw new Error(browserMissing);
  const { chromium } = await import('playwright-core');
  return chromium.launch({ executablePath, headless: true, args: browserArguments });
}

/** What scripts of tests have at hand on every page: Playwright's locators see into elements, `document` does not. */
function atHand() {
  /** What is inside an element, by a selector of its own. */
  globalThis.within = (host, selector) => document.querySelector(host)?.shadowRoot?.querySelector(selector);
  /** What has the focus, inside elements too. */
  globalThis.focused = () => {
    let found = document.activeElement;
    while (found?.shadowRoot?.activeElement) found = found.shadowRoot.activeElement;
    return found;
  };
}

/**
 * Opens a page in a fresh context, with what `before` runs ahead of its scripts, and keeps a list of what goes wrong on it.
 * Sockets go wrong but those to its own server, which development servers have, and those whose address `sockets` matches.
 */
export async function openPage(
  browser,
  url,
  { viewport = 'desktop', scheme = 'light', path = '', before = '', sockets = null, ...rest } = {},
) {
  const context = await browser.newContext({
    viewport: viewports[viewport],
    colorScheme: scheme,
    reducedMotion: 'reduce',
    hasTouch: viewport === 'phone',
    // Each test asks the server, and finds what it gives; those of offline use let the worker work.
    serviceWorkers: 'block',
    ...rest,
  });
  const problems = [];
  const { origin } = new URL(url);
  context.on('weberror', (error) => problems.push(`uncaught: ${error.error().stack ?? error.error()}`));
  context.on('console', (message) => {
    if (message.type() === 'error') problems.push(`console: ${message.text()}`);
  });
  context.on('request', (request) => {
    const target = new URL(request.url());
    if (target.protocol.startsWith('http') && target.origin !== origin) problems.push(`request to ${target.href}`);
  });
  context.on('requestfailed', (request) => {
    const reason = request.failure()?.errorText;
    // What the page itself gives up, as by its Cancel, is no failure.
    if (reason !== 'net::ERR_ABORTED') problems.push(`failed: ${request.url()} ${reason}`);
  });
  context.on('response', (response) => {
    if (response.status() >= 400) problems.push(`status ${response.status()}: ${response.url()}`);
  });
  await context.addInitScript(atHand);
  if (before) await context.addInitScript({ content: before });
  const page = await context.newPage();
  page.on('websocket', (socket) => {
    if (new URL(socket.url()).host !== new URL(url).host && !sockets?.test(socket.url()))
      problems.push(`socket to ${socket.url()}`);
  });
  page.setDefaultTimeout(20_000);
  await page.goto(new URL(path, url).href, { waitUntil: 'load' });

  const screenshot = async (name, options = {}) => {
    const folder = join(outputFolder, 'screenshots');
    mkdirSync(folder, { recursive: true });
    const file = join(folder, `${name}-${viewport}-${scheme}.png`);
    await page.screenshot({ path: file, ...options });
    return file;
  };
  return { page, context, problems, screenshot, close: () => context.close() };
}
