import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vite';

const path = (name: string) => fileURLToPath(new URL(name, import.meta.url));

/** The demo. It imports the built package by its name, as a user's page would. */
export default defineConfig({
  root: path('web/app'),
  base: './',
  resolve: {
    alias: [
      { find: /^boresight$/, replacement: path('dist/lib/browser.js') },
      { find: /^boresight\/schema\.json$/, replacement: path('web/lib/generated/schema.json') },
      { find: /^boresight\/neural$/, replacement: path('dist/lib/neural-browser.js') },
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
  },
});
