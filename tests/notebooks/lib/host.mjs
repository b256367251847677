/** A server of notebooks on this machine, and a page of it that reaches nothing else. */
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { cpSync, mkdirSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { freePort } from '../../../scripts/lib/free-port.mjs';
import { root } from '../../../scripts/lib/paths.mjs';
import { recordings } from '../../browser/lib/demo.mjs';
import { launch, outputFolder, viewports } from '../../browser/lib/session.mjs';

/** The Python of a virtual environment with the package and the hosts (scripts/test-notebooks.mjs). */
export const python = process.env.NOTEBOOKS_PYTHON;

/** Python snippets of docs/notebooks.md, in order. */
export const snippets = [
  ...readFileSync(join(root, 'docs', 'notebooks.md'), 'utf8').matchAll(/^```python\n(.*?)^```$/gms),
].map(([, code]) => code.trim());

const forMarimo = (code) => /\bmo\b/.test(code);
const forStreamlit = (code) => /\bstreamlit\b/.test(code);
export const of = {
  jupyter: snippets.filter((code) => !forMarimo(code) && !forStreamlit(code)),
  marimo: snippets.filter(forMarimo),
  streamlit: snippets.filter(forStreamlit),
};

/** A folder with the recordings that the snippets name. */
export function workFolder() {
  const folder = mkdtempSync(join(tmpdir(), 'boresight-notebooks-'));
  for (const name of ['delphi', 'awr1642']) cpSync(recordings(name), folder, { recursive: true });
  return folder;
}

/** Starts `python -m` with arguments that know a free port, and waits until `path` answers. What it writes is told on failure. */
export async function start(folder, path, args) {
  if (!python) throw new Error('npm run test:notebooks starts these tests');
  const port = await freePort();
  const url = `http://127.0.0.1:${port}/`;
  const home = join(folder, '.home');
  mkdirSync(home, { recursive: true });
  const child = spawn(python, ['-m', ...args(port)], {
    cwd: folder,
    // A group of its own, which ends as a whole: servers start kernels.
    detached: true,
    stdio: ['ignore', 'pipe', 'pipe'],
    env: {
      PATH: process.env.PATH,
      HOME: home,
      LANG: 'C.UTF-8',
      PYTHONDONTWRITEBYTECODE: '1',
      ...Object.fromEntries(
        ['JUPYTER_CONFIG_DIR', 'JUPYTER_DATA_DIR', 'JUPYTER_RUNTIME_DIR', 'IPYTHONDIR'].map((name) => [
          name,
          join(home, name),
        ]),
      ),
    },
  });
  let written = '';
  for (const stream of [child.stdout, child.stderr])
    stream.setEncoding('utf8').on('data', (text) => {
      written += text;
    });
  let ended = false;
  const end = new Promise((resolve) => {
    child.once('close', () => {
      ended = true;
      resolve();
    });
  });
  const kill = (signal) => {
    try {
      process.kill(-child.pid, signal);
    } catch {
      // It has ended.
    }
  };
  const removeFolder = () => rmSync(folder, { recursive: true, force: true, maxRetries: 5 });
  const atExit = () => {
    kill('SIGKILL');
    removeFolder();
  };
  process.once('exit', atExit);
  for (const signal of ['SIGINT', 'SIGTERM']) process.once(signal, () => process.exit(1));
  const close = async () => {
    kill('SIGTERM');
    const late = setTimeout(() => kill('SIGKILL'), 5_000);
    await end;
    clearTimeout(late);
    kill('SIGKILL');
    process.off('exit', atExit);
    removeFolder();
  };
  for (let tries = 0; ; tries++) {
    const ok = await fetch(new URL(path, url)).then(
      (answer) => answer.ok,
      () => false,
    );
    if (ok) break;
    if (ended || tries > 600) {
      await close();
      throw new Error(`${args(port).join(' ')} did not start:\n${written}`);
    }
    await new Promise((resolve) => setTimeout(resolve, 100));
  }
  return { url, close, written: () => written };
}

/** A page of a server. `outside` are requests to anywhere else, which fail; `problems` are errors that the elements caused. */
export async function open(server, path, { scheme = 'light', viewport = viewports.desktop } = {}) {
  const browser = await launch();
  const context = await browser.newContext({ colorScheme: scheme, viewport, reducedMotion: 'reduce' });
  const { host } = new URL(server.url);
  const [outside, problems] = [[], []];
  const inside = (address) => {
    const { protocol, host: asked } = new URL(address);
    return !/^(http|ws)s?:$/.test(protocol) || asked === host;
  };
  await context.route(
    (address) => !inside(address),
    (route) => {
      outside.push(route.request().url());
      return route.abort();
    },
  );
  const page = await context.newPage();
  page.on('websocket', (socket) => {
    if (!inside(socket.url())) outside.push(socket.url());
  });
  context.on('weberror', (error) => problems.push(error.error().stack ?? String(error.error())));
  page.setDefaultTimeout(30_000);
  await page.goto(new URL(path, server.url).href);
  const screenshot = async (name) => {
    mkdirSync(join(outputFolder, 'screenshots'), { recursive: true });
    await page.screenshot({ path: join(outputFolder, 'screenshots', `notebooks-${name}.png`) });
  };
  return { page, outside, problems, screenshot, close: () => browser.close() };
}

/** What an element says of its picture, once it says what is asked for. */
export async function says(element, words) {
  const alternative = element.locator('.alternative').filter({ hasText: words });
  await alternative.waitFor({ state: 'attached' });
  return alternative.textContent();
}

/** Clicks a plot as a mouse does, halfway up and a quarter from the left. */
export async function clickPlot(page, element) {
  const plot = element.locator('.u-over');
  await plot.scrollIntoViewIfNeeded();
  const { x, y, width, height } = await plot.boundingBox();
  const [left, top] = [x + width / 4, y + height / 2];
  await page.mouse.move(left - 20, top);
  await page.mouse.move(left, top, { steps: 4 });
  await page.mouse.click(left, top);
}

/**
 * Gives `test` for the steps of one story: those after a failed one would only wait. `view` gives the page, of which a failure
 * leaves a picture.
 */
export function story(view) {
  let failed = false;
  return (name, body) =>
    test(name, { timeout: 120_000 }, async () => {
      assert.ok(!failed, 'a step before this one failed');
      failed = true;
      try {
        await body();
        failed = false;
      } catch (error) {
        await view()?.screenshot(`failed-${name.replaceAll(/\W+/g, '-')}`);
        throw error;
      }
    });
}
