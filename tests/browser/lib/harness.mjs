/**
 * Tests on pages of the built demo in headless Chromium. A test fails on anything the page reports
 * as wrong: console errors, uncaught errors, failed or refused requests, and requests elsewhere.
 */
import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { browserMissing, findBrowser } from '../../../scripts/lib/browser.mjs';
import { launch, openPage, serve } from './session.mjs';

const opened = [];
let shared;
const site = () => {
  // The browser first: where there is none, no server is left that keeps the process alive.
  shared ??= (async () => {
    for (const start of [launch, serve]) opened.push(await start());
    return opened;
  })();
  return shared;
};

/** Skips without a browser, except under CI, where a missing one is a failure. */
export const skipWithoutBrowser = findBrowser() || process.env.CI ? false : browserMissing;

after(async () => {
  for (const one of opened) await one.close();
});

/**
 * A test that needs the browser. Under CI, where other work may slow a page, a failed test runs once
 * more. If it passes then, the closing lines of the run name it (`passedOnRetry` in
 * scripts/lib/summary.mjs).
 */
export function retriedTest(name, { timeout = 90_000 }, body) {
  const attempts = process.env.CI ? 2 : 1;
  test(name, { skip: skipWithoutBrowser, timeout: attempts * timeout }, async (context) => {
    for (let attempt = 1; ; attempt++) {
      try {
        await body(context);
        if (attempt > 1) console.error(`passed on retry: ${name}`);
        return;
      } catch (error) {
        if (attempt === attempts) throw error;
        console.error(error);
      }
    }
  });
}

/**
 * A test on a page of the demo. Options: `path`, `viewport` (`desktop`, `phone`), `scheme` (`light`,
 * `dark`), `before` (a script ahead of the page's own), `sockets` (addresses it may connect to),
 * `served` (gives another site than the built demo), `timeout` (ms), and any of Playwright's context
 * options. On failure the page is pictured in tests/.output/screenshots.
 */
export function browserTest(name, { served, timeout, ...options }, body) {
  retriedTest(name, { timeout }, (context) => runOnPage(name, served, options, body, context));
}

async function runOnPage(name, served, options, body, context) {
  const [browser, demo] = await site();
  const server = served ? await served() : demo;
  const view = await openPage(browser, server.url, options);
  try {
    await body({ ...view, url: server.url, browser, test: context });
    assert.deepEqual(view.problems, [], 'the page reported no problem');
  } catch (error) {
    const file = await view.screenshot(`failed-${name.replaceAll(/\W+/g, '-')}`).catch(() => null);
    const reports = [
      view.problems.length > 0 && `The page reported: ${view.problems.join('; ')}`,
      file && `Picture: ${file}`,
    ];
    console.error(reports.filter(Boolean).join('\n'));
    throw error;
  } finally {
    await view.close();
  }
}
