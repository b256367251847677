import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vite';

const path = (name: string) => fileURLToPath(new URL(name, import.meta.url));

/** The front end of python/boresight-widget: elements and what they compute with in one file that asks for nothing. */
export default defineConfig({
  publicDir: false,
  resolve: { alias: [{ find: /^boresight(\/worker)?$/, replacement: path('dist/inline/boresight.js') }] },
  build: {
    target: 'es2022',
    outDir: path('python/boresight-widget/boresight_widget/static'),
    emptyOutDir: true,
    minify: true,
    license: { fileName: 'LICENSES.md' },
    lib: { entry: path('web/notebook/widget.ts'), formats: ['es'], fileName: () => 'widget.js' },
    rolldownOptions: { output: { codeSplitting: false, minify: true } },
  },
});
