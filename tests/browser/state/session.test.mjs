import assert from 'node:assert/strict';
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { twoFrames } from '../lib/controls.mjs';
import { skipWithoutBrowser } from '../lib/harness.mjs';
import { launch, openPage, serve } from '../lib/session.mjs';

const pages = {
  'good.html': '<main>good</main><script>console.log("fine")</script>',
  'console.html': '<script>console.error("said wrong")</script>',
  'throws.html': '<script>setTimeout(() => { throw new Error("thrown late"); })</script>',
  'rejects.html': '<script>Promise.reject(new Error("nobody listens"))</script>',
  'missing.html': '<img src="../not-there.png" alt="">',
  'elsewhere.html': '<script>fetch("http://127.0.0.1:9/").catch(() => {})</script>',
  'worker.html': '<script>new Worker(URL.createObjectURL(new Blob(["throw new Error(\'in the worker\')"])))</script>',
};

const options = { skip: skipWithoutBrowser };
let folder;
let server;
let browser;

before(async () => {
  if (skipWithoutBrowser) return;
  folder = mkdtempSync(join(tmpdir(), 'boresight-site-'));
  mkdirSync(join(folder, 'dist'));
  for (const [name, body] of Object.entries(pages)) {
    writeFileSync(join(folder, 'dist', name), `<!doctype html><link rel="icon" href="data:,"><title>t</title>${body}`);
  }
  browser = await launch();
  server = await serve(folder);
});
after(async () => {
  await browser?.close();
  await server?.close();
  if (folder) rmSync(folder, { recursive: true });
});

/** Problems of a page once one matches; without a pattern once the page rests. */
const problemsOf = async (path, pattern) => {
  const { page, problems, close } = await openPage(browser, server.url, { path });
  await page.waitForLoadState('networkidle');
  for (let tries = 0; pattern && tries < 200 && !problems.some((problem) => pattern.test(problem)); tries++)
    await twoFrames(page);
  await close();
  return problems;
};

test('a page without problems has none', options, async () => {
  assert.deepEqual(await problemsOf('good.html'), []);
});

const expected = {
  'console.html': /said wrong/,
  'throws.html': /thrown late/,
  'rejects.html': /nobody listens/,
  'missing.html': /status 404.*not-there\.png/,
  'elsewhere.html': /request to http:\/\/127\.0\.0\.1:9/,
  'worker.html': /in the worker/,
};
for (const [path, pattern] of Object.entries(expected)) {
  test(`${path} is reported`, options, async () => {
    const problems = await problemsOf(path, pattern);
    assert.ok(
      problems.some((problem) => pattern.test(problem)),
      `${JSON.stringify(problems)} should hold ${pattern}`,
    );
  });
}

test('viewport and colour scheme are what was asked for', options, async () => {
  const opened = await openPage(browser, server.url, { path: 'good.html', viewport: 'phone', scheme: 'dark' });
  const seen = await opened.page.evaluate(() => [innerWidth, matchMedia('(prefers-color-scheme: dark)').matches]);
  await opened.close();
  assert.deepEqual(seen, [390, true]);
});
