// The demo as `npm start` serves it while the module of networks is being built.
import assert from 'node:assert/strict';
import { copyFileSync, mkdtempSync, readdirSync, readFileSync, renameSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { root } from '../../scripts/lib/paths.mjs';
import { values } from './demo.mjs';
import { browserTest } from './harness.mjs';
import { serve } from './session.mjs';

const folder = mkdtempSync(join(tmpdir(), 'boresight-later-'));
const site = join(folder, 'site');
const patient = { timeout: 60_000 };
const angles = '#/angle?array=lrr48&targets=-20:0,5:-3,31:-6&snr=25&snapshots=1&seed=2&methods=iaa,learned-pursuit';
const estimated = (method) => `[data-row="${method}"] [data-field="error"][data-value]`;

/** What the build says. */
function say(state) {
  writeFileSync(join(folder, 'new'), JSON.stringify(state));
  renameSync(join(folder, 'new'), join(folder, 'state.json'));
}

function moduleComes() {
  for (const name of ['boresight_neural.js', 'boresight_neural_bg.wasm'])
    copyFileSync(join(root, 'dist', 'wasm', name), join(folder, name));
  say({ state: 'ready' });
}

let server;
/** The demo, built and served as beside a build. */
function served() {
  server ??= (async () => {
    process.env.BORESIGHT_NETWORKS = folder;
    const options = { configFile: join(root, 'vite.config.ts'), logLevel: 'warn', build: { outDir: site } };
    const { build } = await import('vite');
    await build(options);
    return serve(join(root, 'web', 'app'), options);
  })();
  return server;
}
after(async () => {
  await (await server)?.close();
  rmSync(folder, { recursive: true });
});

browserTest(
  'networks later: a page that is up before the module says so, and estimates when it has come',
  { served, path: angles },
  async ({ page }) => {
    assert.deepEqual(
      readdirSync(join(site, 'assets')).filter((name) => name.includes('neural')),
      [],
      'the module is no part of the site',
    );
    await page.waitForSelector('[data-loading] [data-module="waiting"]');
    // Workers that are there before the module are given it too.
    await page.waitForSelector(estimated('iaa'), patient);
    assert.doesNotMatch(await page.locator('[data-row="learned-pursuit"]').innerText(), /missed/);
    say({ state: 'building', started: Date.now() - 65_000, step: 'Compiling tract-core v0.23.9' });
    await page.waitForSelector('[data-loading] [data-module="building"]');
    assert.match(await page.locator('[data-loading] [data-module]').innerText(), /being built, for 1:\d\d min so far/);
    await page.locator('nav a[href^="#/networks"]').click();
    await page.waitForSelector('.notice [data-module="building"]');
    await page.locator('nav a[href^="#/angle"]').click();
    moduleComes();
    await page.waitForSelector(estimated('learned-pursuit'), patient);
    for (const error of await values(page, '[data-row="learned-pursuit"] [data-field="error"]'))
      assert.ok(Math.abs(error) < 0.3, `${error} deg`);
    assert.equal(await page.locator('[data-module]').count(), 0, 'nothing is said of the build any more');
  },
);

browserTest(
  'networks later: a build that failed is told with its reason, is not asked for again and again, and is tried when asked',
  {
    served: () => {
      say({ state: 'failed', reason: 'error: no space left on device' });
      return served();
    },
    path: angles,
  },
  async ({ page }) => {
    const stopped = page.locator('[data-stopped]');
    await stopped.waitFor();
    assert.match(await stopped.innerText(), /could not be built.*no space left on device.*not-built/s);
    await page.waitForSelector(estimated('iaa'), patient);
    const asked = [];
    page.on('request', (request) => asked.push(request.url()));
    await page.waitForTimeout(2500);
    assert.deepEqual(
      asked.filter((address) => address.includes('/later/')),
      [],
    );
    moduleComes();
    await page.locator('[data-action="load"]').click();
    await page.waitForSelector(estimated('learned-pursuit'), patient);
  },
);

test('networks later: what is published asks for no build', () => {
  const assets = join(root, 'web', 'app', 'dist', 'assets');
  const scripts = readdirSync(assets).filter((name) => name.endsWith('.js'));
  assert.ok(scripts.length > 1);
  for (const name of scripts) assert.doesNotMatch(readFileSync(join(assets, name), 'utf8'), /\/later\//, name);
});

say({ state: 'waiting' });
