/** The self-contained files, each alone in a folder, in pages of hosts that allow ever less. */
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { skipWithoutBrowser } from '../browser/lib/harness.mjs';
import { launch } from '../browser/lib/session.mjs';
import { consumer } from './consumer.mjs';
import { servePages } from './pages.mjs';

const skip = skipWithoutBrowser;
const timeout = 120_000;
const WASM = "'wasm-unsafe-eval'";
const packaged = (...path) => readFileSync(join(project.folder, 'node_modules', 'boresight', ...path));
const fixture = (name) => readFileSync(new URL(`fixtures/${name}`, import.meta.url));

/** Reports what a page's program comes to, to the test. */
const report = `
  import { embedded } from './embedded.mjs';
  export const report = (boresight, options) =>
    embedded(boresight, options, globalThis.loaded ?? performance.now()).then(
      (outcome) => ({ outcome }),
      (error) => ({ error: { name: error.name, code: error.code, message: error.message } }),
    ).then((told) => { globalThis.told = told; globalThis.parent.postMessage(told, '*'); });
`;
const html = (...scripts) => `<!doctype html><meta charset="utf-8"><title>host</title>${scripts.join('\n')}`;
const script = (name, type = 'module') => `<script type="${type}" src="./${name}"></script>`;

const REPORT = ['report.mjs', 'embedded.mjs', 'program.mjs'];

/** Each page's script, by its name. */
const scripts = {
  'module.mjs': `
    import * as boresight from './boresight.js';
    import { report } from './report.mjs';
    report(boresight);
  `,
  'classic.mjs': "import { report } from './report.mjs'; report(globalThis.boresight);",
  'function.mjs': `
    import { report } from './report.mjs';
    const text = await (await fetch('./boresight.global.js')).text();
    globalThis.loaded = performance.now();
    new Function(text)();
    report(globalThis.boresight);
  `,
  'blob.mjs': `
    import { report } from './report.mjs';
    const text = await (await fetch('./boresight.js')).text();
    globalThis.loaded = performance.now();
    report(await import(URL.createObjectURL(new Blob([text], { type: 'text/javascript' }))));
  `,
  'elsewhere.mjs': `
    import { report } from './report.mjs';
    report(await import(new URL('./boresight.js', location.href.replace('127.0.0.1', 'localhost'))));
  `,
  'hosted.mjs': `
    import * as boresight from './boresight.js';
    import { report } from './report.mjs';
    report(boresight, {
      worker: './boresight.worker.js',
      modules: { core: './boresight_bg.wasm', drives: () => fetch('./boresight_drives_bg.wasm') },
    });
  `,
  'networks.mjs': `
    import { createPool } from './boresight.js';
    import { initNeural, Network, networksModule } from './networks.js';
    const onnx = new Uint8Array(await (await fetch('./learned-pursuit.onnx')).arrayBuffer());
    await initNeural();
    const kinds = [new Network(onnx).kind];
    for (const workers of [1, 0]) {
      const pool = createPool({ workers, modules: { networks: networksModule } });
      kinds.push((await pool.loadNetwork({ onnx })).kind);
    }
    const unnamed = await createPool().loadNetwork({ onnx }).catch(({ code }) => code);
    globalThis.told = { kinds, unnamed };
  `,
  'here.mjs': `
    import * as boresight from './boresight.js';
    import { report } from './report.mjs';
    report(boresight, { workers: 0 });
  `,
};
const classic = [script('boresight.global.js', 'text/javascript'), script('classic.mjs')];
/** Pages: their documents, content security policies and the files they ask for. */
const pages = {
  'module.html': { document: html(script('module.mjs')), files: ['module.mjs', 'boresight.js'] },
  'classic.html': { document: html(...classic), files: ['boresight.global.js', 'classic.mjs'] },
  'function.html': { document: html(script('function.mjs')), files: ['function.mjs', 'boresight.global.js'] },
  'blob.html': { document: html(script('blob.mjs')), files: ['blob.mjs', 'boresight.js'] },
  'sandbox.html': {
    document: html('<iframe sandbox="allow-scripts" src="./classic.html"></iframe>'),
    files: ['classic.html', 'boresight.global.js', 'classic.mjs'],
  },
  'strict.html': {
    document: html(script('module.mjs')),
    policy: `default-src 'none'; script-src 'self' ${WASM} blob:; worker-src blob:`,
    files: ['module.mjs', 'boresight.js'],
  },
  'no-workers.html': {
    document: html(script('module.mjs')),
    policy: `default-src 'none'; script-src 'self' ${WASM}; worker-src 'none'`,
    files: ['module.mjs', 'boresight.js'],
  },
  'own-workers.html': {
    document: html(script('module.mjs')),
    policy: `default-src 'none'; script-src 'self' ${WASM}; worker-src 'self'`,
    files: ['module.mjs', 'boresight.js'],
  },
  'here.html': {
    document: html(script('here.mjs')),
    policy: `default-src 'none'; script-src 'self' ${WASM}; worker-src 'none'`,
    files: ['here.mjs', 'boresight.js'],
  },
  'elsewhere.html': { document: html(script('elsewhere.mjs')), files: ['elsewhere.mjs', 'elsewhere/boresight.js'] },
  'hosted.html': {
    document: html(script('hosted.mjs')),
    policy: `default-src 'none'; script-src 'self' ${WASM}; worker-src 'self'; connect-src 'self'`,
    files: ['hosted.mjs', 'boresight.js', 'boresight.worker.js', 'boresight_bg.wasm', 'boresight_drives_bg.wasm'],
  },
  'networks.html': {
    document: html(script('networks.mjs')),
    files: ['networks.mjs', 'boresight.js', 'networks.js', 'learned-pursuit.onnx'],
    alone: true,
  },
  'no-wasm.html': {
    document: html(script('module.mjs')),
    policy: "default-src 'none'; script-src 'self' blob:; worker-src blob:",
    files: ['module.mjs', 'boresight.js'],
  },
};

let project;
let browser;
let server;
let url;
let expected;

/** What the server gives, by the name of the file. */
function contentOf(name) {
  if (pages[name]) return ['text/html', pages[name].document, pages[name].policy];
  if (scripts[name]) return ['text/javascript', scripts[name]];
  if (name === 'report.mjs') return ['text/javascript', report];
  if (name === 'embedded.mjs' || name === 'program.mjs') return ['text/javascript', fixture(name)];
  if (name.endsWith('.onnx')) return ['application/octet-stream', packaged('models', name)];
  if (name.endsWith('.wasm')) return ['application/wasm', packaged('dist', 'wasm', name)];
  return ['text/javascript', packaged('dist', 'inline', name)];
}

before(
  async () => {
    if (skip) return;
    project = await consumer({
      fixtures: ['program.mjs', 'embedded.mjs'],
      files: {
        'node.mjs': `
          import * as boresight from 'boresight';
          import { embeddedAnswers } from './embedded.mjs';
          await Promise.all([boresight.init(), boresight.initDrives()]);
          console.log(JSON.stringify(await embeddedAnswers(boresight)));
        `,
      },
    });
    expected = JSON.parse((await project.run(process.execPath, ['node.mjs'])).stdout);
    assert.ok(Number.isFinite(expected.angleDeg) && expected.sigmaDeg < 1, JSON.stringify(expected));
    server = await servePages(contentOf);
    url = server.url;
    browser = await launch();
  },
  { timeout },
);
after(async () => {
  await browser?.close();
  server?.close();
  project?.remove();
});

/** What a page told, once it asked for its own files and nothing else. */
async function told(name) {
  const page = await browser.newPage();
  const asked = [];
  page.on('request', (request) => asked.push(request.url()));
  try {
    await page.addInitScript(() => {
      if (globalThis === globalThis.top) addEventListener('message', ({ data }) => (globalThis.told = data));
    });
    await page.goto(url + name);
    await page.waitForFunction(() => globalThis.told, null, { timeout: 60_000 });
    const elsewhere = url.replace('127.0.0.1', 'localhost');
    const files = asked
      .filter((address) => !address.startsWith('blob:'))
      .map((address) => address.replace(url, '').replace(elsewhere, 'elsewhere/'));
    const { files: own, alone } = pages[name];
    assert.deepEqual(files.sort(), [name, ...own, ...(alone ? [] : REPORT)].sort());
    return await page.evaluate(() => globalThis.told);
  } finally {
    await page.close();
  }
}

/** A page that works out what Node does, on the page and on its pool. */
function works(name, what) {
  test(`${what} works out what Node does`, { skip, timeout }, async (context) => {
    const { outcome, error } = await told(name);
    assert.equal(error, undefined);
    // Simulations are the same on every platform; so is the arithmetic of one module.
    assert.deepEqual(outcome.here, expected);
    assert.deepEqual(outcome.pool, expected);
    context.diagnostic(`first estimate ${outcome.firstMs.toFixed(0)} ms after the script`);
  });
}

/** A page where something is refused by a typed error. */
function refuses(name, what, code) {
  test(`${what} gets the typed error ${code}`, { skip, timeout }, async () => {
    const { error } = await told(name);
    assert.deepEqual([error?.name, error?.code], ['BoresightError', code], error?.message);
  });
}

works('module.html', 'a plain page with a module');
works('classic.html', 'a classic script');
works('function.html', 'new Function');
works('blob.html', 'a module from a blob');
works('elsewhere.html', 'a module of another origin');
works('sandbox.html', 'a sandboxed frame');
works('strict.html', 'a policy of the own scripts and blobs');
works('hosted.html', 'a policy of the own workers, by the files that the host gives,');
works('here.html', 'a page without workers, by workers: 0,');
refuses('no-workers.html', 'a policy without workers', 'worker-refused');
refuses('own-workers.html', 'a policy of the own workers alone', 'worker-refused');
refuses('no-wasm.html', 'a policy without WebAssembly', 'not-loaded');

test('networks are a second file, whose module a pool is given', { skip, timeout }, async () => {
  assert.deepEqual(await told('networks.html'), { kinds: ['aaetr', 'aaetr', 'aaetr'], unnamed: 'no-module' });
});
