// The built demo as a server should give it: with a Brotli and a gzip file beside each that gains by it, names that tell
// the contents kept for good, and the page itself asked for anew.
import { readdirSync, writeFileSync } from 'node:fs';
import { readFile } from 'node:fs/promises';
import { join, resolve } from 'node:path';
import { promisify } from 'node:util';
import { brotliCompress, constants, gzip } from 'node:zlib';
import sirv from 'sirv';

/** Weights and recordings that are compressed already gain next to nothing. */
const GAINS = /\.(html|js|css|json|svg|wasm|bin|dat)$/;
/** The best quality takes some 2 s a MB; the next is some percent larger and ten times as fast. */
const BEST_BELOW_BYTES = 2 ** 21;

const brotli = promisify(brotliCompress);
const zip = promisify(gzip);

/** Writes `.br` and `.gz` beside the files of a folder. */
export async function compressFolder(folder) {
  const files = readdirSync(folder, { recursive: true, withFileTypes: true })
    .filter((entry) => entry.isFile() && GAINS.test(entry.name))
    .map((entry) => join(entry.parentPath, entry.name));
  await Promise.all(
    files.map(async (file) => {
      const bytes = await readFile(file);
      const quality = bytes.length < BEST_BELOW_BYTES ? 11 : 9;
      const [small, wide] = await Promise.all([
        brotli(bytes, {
          params: {
            [constants.BROTLI_PARAM_QUALITY]: quality,
            [constants.BROTLI_PARAM_LGWIN]: constants.BROTLI_MAX_WINDOW_BITS,
            [constants.BROTLI_PARAM_SIZE_HINT]: bytes.length,
          },
        }),
        zip(bytes),
      ]);
      for (const [made, ending] of [
        [small, 'br'],
        [wide, 'gz'],
      ]) {
        if (made.length < 0.95 * bytes.length) writeFileSync(`${file}.${ending}`, made);
      }
    }),
  );
}

/** Serves a folder so. */
export function serveFolder(folder) {
  return sirv(folder, {
    brotli: true,
    gzip: true,
    etag: true,
    setHeaders: (response, path) => {
      const kept = path.startsWith('/assets/');
      response.setHeader('Cache-Control', kept ? 'public, max-age=31536000, immutable' : 'no-cache');
      response.setHeader('X-Content-Type-Options', 'nosniff');
    },
  });
}

/** Compresses what Vite has built, and serves it in the preview. */
export function compressed() {
  let folder = '';
  return {
    name: 'compressed',
    configResolved: ({ root, build }) => {
      folder = resolve(root, build.outDir);
    },
    closeBundle: { order: 'post', sequential: true, handler: () => compressFolder(folder) },
    configurePreviewServer: ({ middlewares }) => void middlewares.use(serveFolder(folder)),
  };
}
