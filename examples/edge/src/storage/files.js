/** A file for each name, written anew beside the old one and put in its place: for Node without SQLite. */
import { createHash } from 'node:crypto';
import { mkdirSync, readdirSync, readFileSync, rmSync } from 'node:fs';
import { open, rename, rm } from 'node:fs/promises';
import { join } from 'node:path';
import { pack, unpack } from './pack.js';
import { together } from './together.js';

const END = '.kept';

/** @typedef {{ name: string, atMs: number | null, values: Map<string, Uint8Array> }} Kept */

/** @param {string} path @returns {Kept} */
function readFile(path) {
  const [{ name, atMs, keys }, ...parts] = unpack(readFileSync(path));
  return {
    name,
    atMs,
    values: new Map(keys.map((/** @type {string} */ key, /** @type {number} */ i) => [key, parts[i]])),
  };
}

/** Writes and waits for the disk; a folder is waited for alone. @param {string} path @param {string} flags @param {Uint8Array} [bytes] */
async function synced(path, flags, bytes) {
  const file = await open(path, flags);
  try {
    if (bytes) await file.writeFile(bytes);
    await file.sync();
  } finally {
    await file.close();
  }
}

/** @param {string} folder @returns {import('./storage.js').Database} */
export function openFiles(folder) {
  mkdirSync(folder, { recursive: true });
  for (const file of readdirSync(folder)) if (!file.endsWith(END)) rmSync(join(folder, file));

  const commit = together(async (/** @type {Map<string, Kept | null>[]} */ writes) => {
    // Each holds all of its object, so the last one is enough.
    const last = new Map(writes.flatMap((write) => [...write]));
    await Promise.all(
      Array.from(last, async ([path, kept]) => {
        if (!kept) return rm(path, { force: true });
        const { name, atMs, values } = kept;
        await synced(`${path}.new`, 'w', pack({ name, atMs, keys: [...values.keys()] }, ...values.values()));
        await rename(`${path}.new`, path);
      }),
    );
    await synced(folder, 'r');
  });

  return {
    open(name) {
      const path = join(folder, createHash('sha256').update(name).digest('hex') + END);
      /** @type {Kept | undefined} */
      let kept;
      const load = () => {
        try {
          kept ??= readFile(path);
        } catch (error) {
          if (/** @type {any} */ (error).code !== 'ENOENT') throw error;
          kept = { name, atMs: null, values: new Map() };
        }
        return kept;
      };
      const save = (/** @type {Kept} */ next) => {
        kept = next;
        return commit(new Map([[path, next]]));
      };
      return {
        read: () => load().values,
        write(changes) {
          const values = new Map(load().values);
          for (const [key, value] of changes) value ? values.set(key, value) : values.delete(key);
          return save({ ...load(), values });
        },
        clear() {
          kept = { name, atMs: null, values: new Map() };
          return commit(new Map([[path, null]]));
        },
        alarm: () => load().atMs,
        setAlarm: (atMs) => save({ ...load(), atMs }),
      };
    },
    alarms: () =>
      readdirSync(folder)
        .map((file) => readFile(join(folder, file)))
        .flatMap(({ name, atMs }) => (atMs === null ? [] : [{ name, atMs }])),
  };
}
