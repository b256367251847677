/** What the tests of the demo's pages have in common. */
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { readFile } from 'node:fs/promises';
import { join } from 'node:path';
import { root } from '../../../scripts/lib/paths.mjs';

export const recordings = (folder) => join(root, 'recordings', folder);
export const recording = (name) => readFileSync(join(recordings('awr1642'), name));

/** Numbers of the cells a selector finds; what is empty is left out. */
export const values = (page, selector) =>
  page
    .locator(selector)
    .evaluateAll((cells) =>
      cells.flatMap(({ dataset }) => (dataset.value === undefined ? [] : [Number(dataset.value)])),
    );

/** Loads the page again once its pictures and the other pages' scripts are there: a request that is under way would fail. */
export async function reload(page) {
  await page.waitForFunction(() => [...document.images].every(({ complete }) => complete));
  await page.waitForLoadState('networkidle');
  await page.reload();
}

/** The state in the address. */
export const parameters = (page) => new URLSearchParams(new URL(page.url()).hash.split('?')[1]);

/** Waits until the address holds what `check` wants. */
export async function parametersWith(page, check) {
  for (let tries = 0; tries < 200; tries++) {
    if (check(parameters(page))) return;
    await page.waitForTimeout(50);
  }
  assert.fail(`the address is ${page.url()}`);
}

/** Of ten downloads in a second Chromium drops the next without a word. */
const DOWNLOAD_PAUSE = 110;

/** Clicks what saves a file, a locator or a selector, and gives its name and bytes. */
export async function saved(page, button) {
  await page.waitForTimeout(DOWNLOAD_PAUSE);
  const target = typeof button === 'string' ? page.locator(button) : button;
  const [download] = await Promise.all([page.waitForEvent('download'), target.click()]);
  return { name: download.suggestedFilename(), bytes: await readFile(await download.path()) };
}

/** Checks that a CSV has the header, rows under it, and as many fields in each. */
export function assertCsv({ name, bytes }, header) {
  assert.match(name, /^boresight-.*\.csv$/);
  const lines = bytes.toString('utf8').trimEnd().split('\r\n');
  assert.equal(lines[0], header);
  assert.ok(lines.length > 1, `${name} has rows under its header`);
  for (const line of lines.slice(1)) assert.equal(line.split(',').length, header.split(',').length, line);
  return lines.slice(1).map((line) => line.split(','));
}

export function assertJson({ name, bytes }) {
  assert.match(name, /^boresight-.*\.json$/);
  return JSON.parse(bytes.toString('utf8'));
}

/**
 * Clicks the first button that shows up under a selector, at once: how long the work behind it takes is the machine's
 * affair.
 */
export const clickWhenThere = (page, selector) =>
  page.evaluate(
    (wanted) =>
      new Promise((resolve) => {
        const look = () => {
          const button = document.querySelector(wanted);
          if (!button) return;
          observer.disconnect();
          const { value, max } = button.parentElement.querySelector('progress');
          button.click();
          resolve({ value, max });
        };
        const observer = new MutationObserver(look);
        observer.observe(document.body, { childList: true, subtree: true });
        look();
      }),
    selector,
  );

export function assertPng({ name, bytes }) {
  assert.match(name, /^boresight-.*\.png$/);
  assert.deepEqual([...bytes.subarray(0, 8)], [0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]);
  assert.ok(bytes.length > 4000, `${name} has ${bytes.length} bytes`);
}

/** Drops files on the page as from a file manager; `times` repeats the bytes. */
export const drop = (page, files) =>
  page.evaluate(
    (list) => {
      const transfer = new DataTransfer();
      for (const { name, base64, times = 1 } of list) {
        const bytes = Uint8Array.from(atob(base64), (character) => character.charCodeAt(0));
        transfer.items.add(
          new File(
            Array.from({ length: times }, () => bytes),
            name,
          ),
        );
      }
      for (const type of ['dragover', 'drop']) {
        window.dispatchEvent(new DragEvent(type, { dataTransfer: transfer, bubbles: true, cancelable: true }));
      }
    },
    files.map(({ bytes, ...rest }) => ({ ...rest, base64: Buffer.from(bytes).toString('base64') })),
  );
