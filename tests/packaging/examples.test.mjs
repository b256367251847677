/** The examples of docs/examples, as they stand there: installed, built by their own scripts, used in Chromium. */
import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { mkdirSync, readdirSync, readFileSync, statSync, symlinkSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { isDeepStrictEqual } from 'node:util';
import { root } from '../../scripts/lib/paths.mjs';
import { skipWithoutBrowser } from '../browser/lib/harness.mjs';
import { launch, openPage, serve } from '../browser/lib/session.mjs';
import { consumer } from './consumer.mjs';

const timeout = 120_000;
const examples = ['react', 'vue', 'svelte', 'webpack', 'esbuild', 'import-map'];
const files = ['front_radar.csv.gz', 'pose_10hz.csv.gz'].map((name) => join(root, 'recordings', 'delphi', name));

let project;
let browser;
let expected;
before(
  async () => {
    project = await consumer({ examples, fixtures: ['examples.mjs'] });
    for (const name of examples) if (name !== 'import-map') await project.script(name, 'build');
    // Installed alone, the page has the package in its own folder.
    const own = join(project.folder, 'import-map', 'node_modules');
    mkdirSync(own);
    symlinkSync(join(project.folder, 'node_modules', 'boresight'), join(own, 'boresight'), 'junction');
    await project.run(project.bin('esbuild'), ['react/src/scene.ts', '--outfile=react/scene.js']);
    expected = JSON.parse((await project.run(process.execPath, ['examples.mjs', ...files])).stdout);
    if (!skipWithoutBrowser) browser = await launch();
  },
  { timeout: 300_000 },
);
after(async () => {
  await browser?.close();
  project?.remove();
});

/** Vite's development server, as `npm run dev` of an example starts it. */
async function develop(example) {
  const { createServer } = await import('vite');
  const server = await createServer({
    root: join(project.folder, example),
    logLevel: 'error',
    server: { host: '127.0.0.1', port: 0 },
  });
  await server.listen();
  return { url: `http://127.0.0.1:${server.httpServer.address().port}/`, close: () => server.close() };
}

const served = (example, folder) => serve(project.folder, { build: { outDir: join(project.folder, example, folder) } });

/** A test on the page of an example, which is in `folder` or, without one, developed; nothing may go wrong on it. */
function exampleTest(example, folder, name, body) {
  test(`${example}: ${name}`, { skip: skipWithoutBrowser, timeout }, async () => {
    const server = await (folder ? served(example, folder) : develop(example));
    const { page, problems, close } = await openPage(browser, server.url);
    try {
      await body(page, expected[example]);
      assert.deepEqual(problems, []);
    } finally {
      await close();
      await server.close();
    }
  });
}

/** Waits until what is read on the page is what Node has, to the last digit. */
async function shows(page, read, wanted) {
  const until = Date.now() + 30_000;
  let found = await page.evaluate(read);
  while (!isDeepStrictEqual(found, wanted) && Date.now() < until) {
    await page.evaluate(() => new Promise(requestAnimationFrame));
    found = await page.evaluate(read);
  }
  assert.deepEqual(found, wanted);
}

/** Takes the component off the page: its element goes, and what it drew, and its workers. */
async function unmounts(page, name) {
  const element = await page.locator(name).elementHandle();
  await page.getByRole('checkbox').click();
  await page.locator(name).waitFor({ state: 'detached' });
  assert.equal(await element.evaluate(({ shadowRoot }) => shadowRoot.querySelector('.plot').childElementCount), 0);
  while (page.workers().length > 0) await page.workers()[0].waitForEvent('close');
  // And back.
  await page.getByRole('checkbox').click();
  await page.locator(name).waitFor();
}

const pressed = async (page, key, times) => {
  for (let time = 0; time < times; time++) await page.getByRole('slider').press(key);
};

const azimuths = () =>
  document.querySelector('boresight-spectrum').estimates.map(({ sources }) => sources.map((s) => s.azimuthDeg));

exampleTest('react', null, 'the development server shows it, mounted twice as there', (page, [first]) =>
  shows(page, azimuths, first),
);

exampleTest('react', 'dist', 'a slider moves a target, estimated on workers', async (page, [first, moved]) => {
  await shows(page, azimuths, first);
  assert.equal(page.workers().length, 2);
  await pressed(page, 'ArrowRight', 3);
  await shows(page, azimuths, moved);
  await unmounts(page, 'boresight-spectrum');
  await shows(page, azimuths, first);
});

exampleTest('vue', 'dist', 'a live calibration raises an alarm', async (page, [first, moved]) => {
  const read = () => {
    const { angleDeg, sigmaDeg } = document.querySelector('boresight-mounting-angle').history;
    return [angleDeg.at(-1), sigmaDeg.at(-1)];
  };
  await shows(page, read, first);
  await shows(page, () => document.querySelector('output').textContent, 'pass');
  await pressed(page, 'ArrowRight', 6);
  await shows(page, read, moved);
  await shows(page, () => document.querySelector('output').textContent, 'fail');
  await unmounts(page, 'boresight-mounting-angle');
});

exampleTest('svelte', 'dist', 'scans of a drive are stepped through and played', async (page, [first, fifth]) => {
  const read = () => Array.from(document.querySelector('boresight-point-cloud').points?.rangeM ?? []);
  await shows(page, read, first);
  await pressed(page, 'ArrowRight', 5);
  await shows(page, read, fifth);
  await page.getByRole('button', { name: 'Play' }).click();
  await page.getByText('Scan 9 of').waitFor();
  await page.getByRole('button', { name: 'Pause' }).click();
  await unmounts(page, 'boresight-point-cloud');
  await shows(page, read, first);
});

exampleTest('webpack', '.', 'a batch is split over a pool', async (page, [first, louder]) => {
  const read = () => Number(/^(\S+) deg/.exec(document.querySelector('output').textContent)?.[1]);
  await shows(page, read, first);
  await page.getByRole('slider').press('ArrowRight');
  await shows(page, read, louder);
  assert.ok(page.workers().length > 1, `${page.workers().length} workers`);
});

exampleTest(
  'esbuild',
  '.',
  'files of a drive are opened, on a pool that is told where its files are',
  async (page, wanted) => {
    const chooser = page.waitForEvent('filechooser');
    await page.getByRole('button', { name: 'Open a drive' }).click();
    await (await chooser).setFiles(files);
    const read = () => {
      const { angleDeg, sigmaDeg } = document.querySelector('boresight-drive').calibration?.result ?? {};
      return [angleDeg, sigmaDeg];
    };
    await shows(page, read, wanted);
    assert.deepEqual(
      page.workers().map((worker) => new URL(worker.url()).pathname),
      ['/dist/boresight.worker.js'],
    );
  },
);

exampleTest('import-map', '.', 'a page without a bundler draws frames', async (page, [first, farther]) => {
  const read = () => {
    const { frame } = document.querySelector('boresight-range-doppler');
    const { view } = document.querySelector('boresight-birds-eye');
    const sum = (values) => values.reduce((total, value) => total + value, 0);
    return (
      frame && [frame.detections.map((detection) => detection.azimuthDeg), sum(frame.rangeDopplerDb), sum(view.power)]
    );
  };
  await shows(page, read, first);
  await pressed(page, 'ArrowRight', 1);
  await shows(page, read, farther);
});

/** The modules of a build, by their names in the package, and how large all of it is. */
function modules(example) {
  const wasm = join(project.folder, 'node_modules', 'boresight', 'dist', 'wasm');
  const digestOf = (path) => createHash('sha256').update(readFileSync(path)).digest('hex');
  const names = new Map(
    readdirSync(wasm)
      .filter((name) => name.endsWith('.wasm'))
      .map((name) => [digestOf(join(wasm, name)), name]),
  );
  const built = join(project.folder, example, 'dist');
  const paths = readdirSync(built, { recursive: true }).map((name) => join(built, name));
  const found = paths.filter((path) => path.endsWith('.wasm')).map((path) => names.get(digestOf(path)) ?? path);
  const bytes = paths.reduce((sum, path) => sum + (statSync(path).isFile() ? statSync(path).size : 0), 0);
  return { found: found.sort(), bytes };
}

for (const example of ['react', 'vue', 'svelte', 'webpack', 'esbuild']) {
  test(`${example}: the build of a pool holds no module of networks`, () => {
    const { found, bytes } = modules(example);
    assert.deepEqual(found, ['boresight_bg.wasm', 'boresight_drives_bg.wasm']);
    // Modules of 1.3 and 1.8 MB, and scripts.
    assert.ok(bytes < 4.3e6, `${bytes} bytes`);
  });
}
