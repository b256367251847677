/** Elements of the built package on a page of their own. */
import { after } from 'node:test';
import { root } from '../../../scripts/lib/paths.mjs';
import { browserTest } from '../lib/harness.mjs';
import { serve } from '../lib/session.mjs';

const PAGE = `<!doctype html><html lang="en"><title>elements</title>
<script type="importmap">{ "imports": {
  "boresight": "/lib/browser.js", "boresight/worker": "/worker/browser.js", "boresight/elements": "/elements/index.js"
} }</script>
<style>body { margin: 8px; display: grid; grid-template-columns: 1fr 1fr; gap: 8px; background: Canvas; color: CanvasText }</style>
<body></body></html>`;

/** The built package as a site, on which there is no page. */
let site;
const served = async () => (site ??= await serve(root));
after(() => site?.close());

/** A page with the package and the elements at hand. */
async function open(page, url) {
  await page.route('**/page.html', (route) => route.fulfill({ contentType: 'text/html', body: PAGE }));
  await page.goto(new URL('page.html', url).href);
  await page.evaluate(async () => {
    window.boresight = await import('boresight');
    window.elements = await import('boresight/elements');
    await Promise.all([boresight.init(), boresight.initDrives()]);
    window.add = (name, attributes = {}, properties = {}) => {
      const made = document.createElement(name);
      for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
      document.body.append(Object.assign(made, properties));
      return made;
    };
    /** Two frames of the screen later all is drawn. */
    window.drawn = () => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
    window.part = (element, name) => element.shadowRoot.querySelector(`[part="${name}"]`);
    /** Pixels of the plot that are not its background. */
    window.inked = (element) => {
      const canvas = element.shadowRoot.querySelector('.u-wrap canvas');
      const { data } = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height);
      let count = 0;
      for (let i = 3; i < data.length; i += 4) if (data[i] > 0) count += 1;
      return count / (data.length / 4);
    };
  });
}

export const elementTest = (name, body, options = {}) =>
  browserTest(`elements: ${name}`, { served, path: 'lib/index.js', ...options }, async (view) => {
    // What was there before the page was opened is no problem of the elements.
    await open(view.page, view.url);
    view.problems.length = 0;
    await body(view);
  });
