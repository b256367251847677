/** The panel of docs/examples/single-file, an element and its pool in one file, in pages that load it as hosts do. */
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { skipWithoutBrowser } from '../browser/lib/harness.mjs';
import { launch, openPage } from '../browser/lib/session.mjs';
import { consumer } from './consumer.mjs';
import { servePages } from './pages.mjs';
import { LICHTBLICK } from './policies.mjs';

const skip = skipWithoutBrowser;
const NONCE = 'b29yZXNpZ2h0';

/**
 * `content_security_policy_template` of Grafana's documentation, "Configure security hardening", v13.3, with the nonce
 * and the address of a server.
 */
const GRAFANA =
  `script-src 'self' 'unsafe-eval' 'unsafe-inline' 'strict-dynamic' 'nonce-${NONCE}';object-src 'none';font-src 'self';` +
  "style-src 'self' 'unsafe-inline' blob:;img-src * data:;base-uri 'self';" +
  "connect-src 'self' grafana.com ws://127.0.0.1/ wss://127.0.0.1/;manifest-src 'self';media-src 'none';form-action 'self';";

const html = (...scripts) =>
  `<!doctype html><html lang="en"><meta charset="utf-8"><title>host</title><body></body>${scripts.join('\n')}</html>`;
const inline = (code) => `<script nonce="${NONCE}">${code}</script>`;
const script = (src) => `<script nonce="${NONCE}" src="${src}"></script>`;
/** Plugins of Grafana are AMD modules, which SystemJS runs from a script element or, as from a CDN, from their text. */
const grafana = (fetched) =>
  html(
    script('system.js'),
    script('amd.js'),
    inline(`
      System.constructor.prototype.shouldFetch = () => ${fetched};
      System.import('./dist/panel.js').then(({ mount }) => { unmount = mount(document.body); });
    `),
  );

/** Pages by their names: documents, the example's own by default, and policies. */
const pages = {
  'index.html': {},
  'strict.html': {
    policy: "default-src 'none'; script-src 'self' 'wasm-unsafe-eval' blob:; worker-src blob:; img-src data:",
  },
  'no-workers.html': {
    policy: "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'none'; img-src data:",
  },
  'sandbox.html': {
    document: html('<iframe sandbox="allow-scripts" src="index.html" width="800" height="500"></iframe>'),
  },
  'grafana.html': { document: grafana(false), policy: GRAFANA },
  'grafana-cdn.html': { document: grafana(true), policy: GRAFANA },
  // As buildContributionPoints of Lichtblick does: what it calls with, and what it takes.
  'lichtblick.html': {
    document: html(
      inline(`
        (async () => {
          const source = await (await fetch('./dist/extension.js')).text();
          const module = { exports: {} };
          new Function('module', 'require', source)(module, (name) => ({})[name], {});
          module.exports.activate({
            registerPanel({ initPanel }) {
              unmount = initPanel({ panelElement: document.body.appendChild(document.createElement('div')) });
            },
          });
        })();
      `),
    ),
    policy: LICHTBLICK,
  },
};

let project;
let browser;
let server;
let expected;

function contentOf(name) {
  const example = (...path) => readFileSync(join(project.folder, 'single-file', ...path));
  if (pages[name]) {
    const { document = example('index.html'), policy } = pages[name];
    return ['text/html', document, policy];
  }
  const loader = { 'system.js': 'system.js', 'amd.js': 'extras/amd.js' }[name];
  if (loader) return ['text/javascript', example('..', 'node_modules', 'systemjs', 'dist', loader)];
  return ['text/javascript', example(name)];
}

before(
  async () => {
    if (skip) return;
    project = await consumer({
      examples: ['single-file'],
      fixtures: ['panel.mjs'],
      // The loader that Grafana has.
      packages: { systemjs: '^6.15.1' },
    });
    await project.script('single-file', 'build');
    expected = JSON.parse((await project.run(process.execPath, ['panel.mjs'])).stdout);
    server = await servePages(contentOf);
    browser = await launch();
  },
  { timeout: 180_000 },
);
after(async () => {
  await browser?.close();
  server?.close();
  project?.remove();
});

/** The element draws what Node works out, by so many workers, and leaves with them. */
function shows(name, what, { workers = 1, refused = [] } = {}) {
  test(`${what} shows what Node works out`, { skip, timeout: 60_000 }, async () => {
    const { page, problems, close } = await openPage(browser, server.url, { path: name });
    try {
      const frame = page.frames().at(-1);
      await frame.waitForFunction(() => document.querySelector('boresight-spectrum')?.estimates.length === 2);
      const found = await frame.evaluate(() =>
        document.querySelector('boresight-spectrum').estimates.map(({ sources }) => sources.map((s) => s.azimuthDeg)),
      );
      assert.deepEqual(found, expected);
      await frame.waitForFunction(() =>
        /music: .*°, .*°/.test(
          document.querySelector('boresight-spectrum').shadowRoot.querySelector('.alternative').textContent,
        ),
      );
      assert.equal(page.workers().length, workers);
      // The page of the example takes it away by a check box, hosts by what they were given.
      const box = frame.getByRole('checkbox');
      if ((await box.count()) > 0) await box.click();
      else await frame.evaluate(() => globalThis.unmount());
      while (page.workers().length > 0) await page.workers()[0].waitForEvent('close');
      assert.equal(await frame.locator('boresight-spectrum').count(), 0);
      assert.deepEqual(
        problems.filter((problem) => !refused.some((pattern) => pattern.test(problem))),
        [],
      );
    } finally {
      await close();
    }
  });
}

shows('index.html', 'a plain page');
shows('sandbox.html', 'a sandboxed frame');
shows('strict.html', 'a policy without inline scripts, styles and eval');
shows('no-workers.html', 'a policy without workers', { workers: 0, refused: [/worker/i] });
shows('grafana.html', "Grafana's policy, where its loader makes script elements,");
shows('grafana-cdn.html', "Grafana's policy, where its loader runs text,");
shows('lichtblick.html', "Lichtblick's policy and loader");
