/**
 * Tests on pages of the built demo in headless Chromium. A test fails on anything the page reports
 * as wrong: console errors, uncaught errors, failed or refused requests, and requests elsewhere.
 */
import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { browserMissing, findBrowser } from '../../scripts/lib/browser.mjs';
import { launch, openPage, serve } from './session.mjs';

let shared;
const site = () => {
  shared ??= Promise.all([serve(), launch()]);
  return shared;
};

/** Skips without a browser, except under CI, where a missing one is a failure. */
export const skipWithoutBrowser = findBrowser() || process.env.CI ? false : browserMissing;

after(async () => {
  if (!shared) return;
  const [server, browser] = await shared;
  await browser.close();
  await server.close();
});

/**
 * A test on a page of the demo. Options: `path`, `viewport` (`desktop`, `phone`), `scheme`
 * (`light`, `dark`), and any of Playwright's context options. On failure the page is pictured in
 * tests/.output/screenshots.
 */
export function browserTest(name, options, body) {
  test(name, { skip: skipWithoutBrowser, timeout: 90_000 }, async (context) => {
    const [server, browser] = await site();
    const opened = await openPage(browser, server.url, options);
    try {
      await body({ ...opened, url: server.url, browser, test: context });
      assert.deepEqual(opened.problems, [], 'the page reported no problem');
    } catch (error) {
      const file = await opened.screenshot(`failed-${name.replaceAll(/\W+/g, '-')}`).catch(() => null);
      const reports = [opened.problems.length > 0 && `The page reported: ${opened.problems.join('; ')}`, file && `Picture: ${file}`];
      console.error(reports.filter(Boolean).join('\n'));
      throw error;
    } finally {
      await opened.close();
    }
  });
}
