// The built demo as a server should give it: with a Brotli and a gzip file beside each that gains by it, names that tell
// the contents kept for good, and the page itself asked for anew.
import { createHash } from 'node:crypto';
import { readdirSync, writeFileSync } from 'node:fs';
import { mkdir, readdir, readFile, rename, rm, stat, utimes, writeFile } from 'node:fs/promises';
import { join, resolve } from 'node:path';
import { promisify } from 'node:util';
import { brotliCompress, constants, gzip as zip } from 'node:zlib';
import sirv from 'sirv';
import { cache } from '../paths.mjs';

/** Weights and recordings that are compressed already gain next to nothing. */
const GAINS = /\.(html|js|css|json|svg|wasm|bin|dat)$/;
/** What no build has used for so long is thrown away, ms. */
const KEPT_MS = 30 * 24 * 3600e3;

/** What builds have compressed before. */
export const compressedBefore = join(cache, 'compressed');

/** Another build may throw a file away at any time. */
const unlessGone = (work) =>
  work.catch((error) => {
    if (error.code === 'ENOENT') return null;
    throw error;
  });

/** Makes it once of the same bytes: the best quality takes some 2 s a MB, and most files are those of the build before. */
export async function once(keep, bytes, ending, make) {
  const file = join(keep, `${createHash('sha256').update(bytes).digest('hex')}.${ending}`);
  const before = await unlessGone(readFile(file));
  if (before) {
    await unlessGone(utimes(file, new Date(), new Date()));
    return before;
  }
  const made = await make();
  await mkdir(keep, { recursive: true });
  // Another build may do the same.
  const part = `${file}.${process.pid}`;
  await writeFile(part, made);
  await rename(part, file);
  return made;
}

/** With Brotli at its best, and the widest window. */
export function brotli(bytes, keep = compressedBefore) {
  const params = {
    [constants.BROTLI_PARAM_QUALITY]: constants.BROTLI_MAX_QUALITY,
    [constants.BROTLI_PARAM_LGWIN]: constants.BROTLI_MAX_WINDOW_BITS,
    [constants.BROTLI_PARAM_SIZE_HINT]: bytes.length,
  };
  return once(keep, bytes, 'br', () => promisify(brotliCompress)(bytes, { params }));
}

export const gzip = (bytes, keep = compressedBefore) =>
  once(keep, bytes, 'gz', () => promisify(zip)(bytes, { level: constants.Z_BEST_COMPRESSION }));

async function forget(keep) {
  for (const name of await readdir(keep)) {
    const file = join(keep, name);
    const known = await unlessGone(stat(file));
    if (known && Date.now() - known.mtimeMs > KEPT_MS) await rm(file, { force: true });
  }
}

/** Writes `.br` and `.gz` beside the files of a folder; `keep` has what was made before. */
export async function compressFolder(folder, keep = compressedBefore) {
  await mkdir(keep, { recursive: true });
  const files = readdirSync(folder, { recursive: true, withFileTypes: true })
    .filter((entry) => entry.isFile() && GAINS.test(entry.name))
    .map((entry) => join(entry.parentPath, entry.name));
  await Promise.all(
    files.map(async (file) => {
      const bytes = await readFile(file);
      const [small, wide] = await Promise.all([brotli(bytes, keep), gzip(bytes, keep)]);
      for (const [made, ending] of [
        [small, 'br'],
        [wide, 'gz'],
      ]) {
        if (made.length < 0.95 * bytes.length) writeFileSync(`${file}.${ending}`, made);
      }
    }),
  );
  await forget(keep);
}

/** Serves a folder so. Files are looked up at each request, as a build may replace them meanwhile. */
export function serveFolder(folder) {
  return sirv(folder, {
    dev: true,
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
