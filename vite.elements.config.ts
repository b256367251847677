import { fileURLToPath } from 'node:url';
import { defineConfig } from 'vite';

const path = (name: string) => fileURLToPath(new URL(name, import.meta.url));

/** `boresight/elements`: custom elements with the plots in them; the package itself stays an import. */
export default defineConfig({
  publicDir: false,
  build: {
    target: 'es2022',
    outDir: path('dist/elements'),
    emptyOutDir: true,
    minify: false,
    // The plots bring other people's code with them.
    license: { fileName: 'LICENSES.md' },
    lib: { entry: path('web/elements/index.ts'), formats: ['es'], fileName: () => 'index.js' },
    rollupOptions: { external: [/^boresight(\/|$)/] },
  },
});
