import { cpSync, existsSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { defineConfig, type Plugin } from 'vite';
import { bundledDrive } from './scripts/lib/build/bundled-drive.mjs';
import { compressed } from './scripts/lib/build/compressed.mjs';
import { elementsModule } from './scripts/lib/build/manifest.mjs';
import { offline } from './web/offline.ts';

const path = (name: string) => fileURLToPath(new URL(name, import.meta.url));

/**
 * What is built has its styles in files; the development server puts them into the page. Attributes are allowed: svgcanvas
 * writes pictures with them.
 */
const styles: Plugin = {
  name: 'styles-in-files',
  apply: 'build',
  transformIndexHtml: (html) => html.replace(" 'unsafe-inline'", "; style-src-attr 'unsafe-inline'"),
};

const reference = path('dist/reference');

/** The API reference, which `npm run build` has made by now and `npm start` does without. */
const withReference: Plugin = {
  name: 'reference',
  apply: 'build',
  writeBundle: ({ dir = '' }) => {
    if (existsSync(reference)) cpSync(reference, join(dir, 'reference'), { recursive: true });
  },
};

/** Set by `npm start` where the module of networks is built while the demo is up. */
const withoutNetworks = process.env.BORESIGHT_WITHOUT_NETWORKS !== undefined;

/** The demo. It imports the built package by its name, as a user's page would. */
export default defineConfig(({ command }) => ({
  root: path('web/app'),
  base: './',
  // The demo is one page: another address is no part of it.
  appType: 'mpa',
  define: {
    WITHOUT_NETWORKS: JSON.stringify(withoutNetworks),
    REFERENCE: JSON.stringify(command === 'build' && existsSync(reference)),
  },
  // A site without its module of networks is not yet what is to be kept.
  plugins: [styles, withReference, bundledDrive(), elementsModule(), offline(!withoutNetworks), compressed()],
  resolve: {
    alias: [
      { find: /^boresight$/, replacement: path('dist/lib/browser.js') },
      { find: /^boresight\/neural$/, replacement: path('dist/lib/neural/browser.js') },
      { find: /^boresight\/schema\.json$/, replacement: path('web/lib/generated/schema.json') },
      { find: /^boresight\/worker$/, replacement: path('dist/worker/browser.js') },
    ],
  },
  worker: { format: 'es' },
  server: { fs: { allow: [path('.')] } },
  build: {
    target: 'es2022',
    outDir: path('web/app/dist'),
    emptyOutDir: true,
    assetsInlineLimit: 0,
    // Scripts of pages come with no styles of their own to wait for.
    cssCodeSplit: false,
  },
}));
