import { createHash } from 'node:crypto';
import { existsSync, mkdirSync, readdirSync, readFileSync, statSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { cache, root } from '../paths.mjs';

const skipped = new Set(['node_modules', 'target', 'dist', '.git', '.tools']);

/** Files under a path of the checkout, sorted, without build outputs. */
export function filesUnder(path) {
  const full = join(root, path);
  if (!existsSync(full)) return [];
  if (!statSync(full).isDirectory()) return [path];
  return readdirSync(full, { withFileTypes: true })
    .filter((entry) => !skipped.has(entry.name))
    .sort((a, b) => (a.name < b.name ? -1 : 1))
    .flatMap((entry) => {
      const child = `${path}/${entry.name}`;
      if (entry.isDirectory()) return filesUnder(child);
      return entry.isFile() ? [child] : [];
    });
}

/** Digest of names and contents of files, and of any further strings. */
export function digest(paths, extra = []) {
  const hash = createHash('sha256');
  for (const path of paths.flatMap(filesUnder)) {
    const content = readFileSync(join(root, path));
    hash.update(`${path}\0${content.length}\0`).update(content);
  }
  for (const text of extra) hash.update(`${text}\0`);
  return hash.digest('hex');
}

const stampOf = (name) => join(cache, `${name}.stamp`);

/** Whether outputs stand that were made of the same inputs, or of those with one of `better` for `extra`. */
export function upToDate(name, { inputs, extra = [], better = [], outputs }) {
  const stamp = stampOf(name);
  if (!existsSync(stamp) || !outputs.every((path) => existsSync(join(root, path)))) return false;
  const found = readFileSync(stamp, 'utf8');
  return [extra, ...better].some((more) => digest(inputs, more) === found);
}

/**
 * Does `work` unless it was done for the same inputs and its outputs still stand. The inputs are
 * read before the work, so that an edit made meanwhile is not missed.
 */
export async function whenChanged(name, made, work) {
  if (upToDate(name, made)) return false;
  const now = digest(made.inputs, made.extra);
  await work();
  const missing = made.outputs.filter((path) => !existsSync(join(root, path)));
  if (missing.length > 0) throw new Error(`${name} ended well but did not make ${missing.join(', ')}`);
  mkdirSync(cache, { recursive: true });
  writeFileSync(stampOf(name), now);
  return true;
}
