/** One file for each name, written beside the old one and renamed over it: for Node without SQLite. */
import { createHash } from 'node:crypto';
import { readdirSync, readFileSync, rmSync } from 'node:fs';
import { open, rename, rm } from 'node:fs/promises';
import { basename, join } from 'node:path';
import { makeFolder } from './folder.js';
import { pack, unpack } from './pack.js';
import { together } from './together.js';

const KEPT = /^[0-9a-f]{64}\.kept$/;
/** Files that a process was writing when it ended. */
const BEGUN = /^[0-9a-f]{64}\.kept\.new$/;

/** @typedef {{ name: string, atMs: number | null, values: Map<string, Uint8Array> }} Kept */
/** Functions of node:fs that tests replace. @typedef {typeof disk} FileSystem */

const disk = { makeFolder, readdirSync, readFileSync, rmSync, open, rename, rm };

const entryOf = (/** @type {string} */ name) => `${createHash('sha256').update(name).digest('hex')}.kept`;

/**
 * @param {string} folder
 * @param {FileSystem} [fs]
 * @returns {import('./storage.js').Database}
 */
export function openFiles(folder, fs = disk) {
  /** @type {Map<string, string>} */
  const unreadable = new Map();
  const failed = (/** @type {string} */ entry, /** @type {unknown} */ error) =>
    unreadable.set(entry, error instanceof Error ? error.message : String(error));

  fs.makeFolder(folder);
  for (const entry of fs.readdirSync(folder)) {
    try {
      if (BEGUN.test(entry)) fs.rmSync(join(folder, entry));
      else if (!KEPT.test(entry)) throw new Error('the name is not one of this service');
    } catch (error) {
      failed(entry, error);
    }
  }

  /** @param {string} path @returns {Kept} */
  function readFile(path) {
    const entry = basename(path);
    try {
      const [{ name, atMs, keys }, ...parts] = unpack(fs.readFileSync(path));
      if (entryOf(name) !== entry) throw new Error(`the file is that of ${name}`);
      unreadable.delete(entry);
      return {
        name,
        atMs,
        values: new Map(keys.map((/** @type {string} */ key, /** @type {number} */ i) => [key, parts[i]])),
      };
    } catch (error) {
      if (/** @type {any} */ (error).code === 'ENOENT') {
        unreadable.delete(entry);
        throw error;
      }
      failed(entry, error);
      throw new Error(`${entry}: ${unreadable.get(entry)}`, { cause: error });
    }
  }

  /** Writes and waits for the disk; without bytes, only waits. @param {string} path @param {string} flags @param {Uint8Array} [bytes] */
  async function synced(path, flags, bytes) {
    const file = await fs.open(path, flags);
    try {
      // A disk that is nearly full takes a part.
      for (let at = 0; bytes && at < bytes.length; ) {
        const { bytesWritten } = await file.write(bytes, at, bytes.length - at);
        if (bytesWritten === 0) throw new Error(`${path}: nothing was written`);
        at += bytesWritten;
      }
      await file.sync();
    } finally {
      await file.close();
    }
  }

  /** Puts new contents under a name, or takes it away. @param {string} path @param {Kept | null} kept */
  async function put(path, kept) {
    if (!kept) return fs.rm(path, { force: true });
    const { name, atMs, values } = kept;
    const begun = `${path}.new`;
    try {
      await synced(begun, 'w', pack({ name, atMs, keys: [...values.keys()] }, ...values.values()));
      await fs.rename(begun, path);
    } catch (error) {
      await fs.rm(begun, { force: true }).catch(() => {});
      throw error;
    }
  }

  const commit = together(async (/** @type {[string, Kept | null][]} */ writes) => {
    /** @type {Map<string, unknown>} */
    const errors = new Map();
    // Each holds all of its object, so the last one is enough. An error is that of its object alone.
    await Promise.all(
      Array.from(new Map(writes), ([path, kept]) => put(path, kept).catch((error) => errors.set(path, error))),
    );
    await synced(folder, 'r');
    return errors;
  });

  return {
    open(name) {
      const path = join(folder, entryOf(name));
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
      const save = async (/** @type {Kept} */ next, /** @type {Kept | null} */ written = next) => {
        kept = next;
        try {
          const errors = await commit([path, written]);
          if (errors.has(path)) throw errors.get(path);
        } catch (error) {
          // Later writes hold all of it. Where there is none, the disk says what is kept.
          if (kept === next) kept = undefined;
          throw error;
        }
      };
      return {
        read: () => load().values,
        write(changes) {
          const values = new Map(load().values);
          for (const [key, value] of changes) value ? values.set(key, value) : values.delete(key);
          return save({ ...load(), values });
        },
        clear: () => save({ name, atMs: null, values: new Map() }, null),
        alarm: () => load().atMs,
        setAlarm: (atMs) => save({ ...load(), atMs }),
      };
    },
    alarms: () =>
      fs
        .readdirSync(folder)
        .filter((entry) => KEPT.test(entry))
        .flatMap((entry) => {
          try {
            const { name, atMs } = readFile(join(folder, entry));
            return atMs === null ? [] : [{ name, atMs }];
          } catch {
            // It is among those that are unreadable.
            return [];
          }
        }),
    unreadable,
    isUnreadable: (name) => unreadable.has(entryOf(name)),
  };
}
