import { createHash } from 'node:crypto';
import { fileURLToPath } from 'node:url';
import { build, type Plugin, type Rolldown } from 'vite';

const worker = fileURLToPath(new URL('app/offline/service-worker.ts', import.meta.url));

/** Larger files, and networks, are kept when they were used; all others at once. */
const LARGE_BYTES = 2 ** 21;

const contents = (file: Rolldown.OutputAsset | Rolldown.OutputChunk): string | Uint8Array =>
  file.type === 'chunk' ? file.code : file.source;

/**
 * Builds the service worker beside the site, with the names of what the site consists of
 * (web/app/offline/service-worker.ts). `on` is false where the site is not to be kept.
 */
export function offline(on: boolean): Plugin {
  return {
    name: 'offline',
    config: (_, { command }) => ({ define: { KEPT_OFFLINE: JSON.stringify(on && command === 'build') } }),
    writeBundle: {
      order: 'post',
      sequential: true,
      async handler({ dir = '' }, bundle) {
        if (!on) return;
        const files = Object.values(bundle);
        const isLarge = (file: (typeof files)[number]): boolean =>
          file.fileName.endsWith('.onnx') || contents(file).length > LARGE_BYTES;
        const release = {
          files: files
            .filter((file) => !isLarge(file))
            .map((file) => ({
              url: file.fileName,
              // Names under assets tell the contents.
              revision: file.fileName.startsWith('assets/')
                ? null
                : createHash('sha256').update(contents(file)).digest('hex').slice(0, 16),
            })),
          large: files.filter(isLarge).map(({ fileName }) => fileName),
        };
        await build({
          configFile: false,
          logLevel: 'warn',
          define: { RELEASE: JSON.stringify(release), 'process.env.NODE_ENV': '"production"' },
          build: {
            target: 'es2022',
            outDir: dir,
            emptyOutDir: false,
            copyPublicDir: false,
            lib: { entry: worker, formats: ['iife'], name: 'boresight', fileName: () => 'service-worker.js' },
          },
        });
      },
    },
  };
}
