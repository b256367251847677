/** A file for each name, written anew beside the old one and put in its place: for Node without SQLite. */
import { createHash } from 'node:crypto';
import { closeSync, fsyncSync, mkdirSync, openSync, readdirSync, readFileSync, renameSync, rmSync, writeSync } from 'node:fs';
import { join } from 'node:path';
import { pack, unpack } from './pack.js';

const END = '.kept';

/** @param {string} folder @returns {import('./storage.js').Database} */
export function openFiles(folder) {
  mkdirSync(folder, { recursive: true });
  for (const file of readdirSync(folder)) if (!file.endsWith(END)) rmSync(join(folder, file));
  const synced = (/** @type {string} */ path, /** @type {string} */ flags, /** @type {Uint8Array[]} */ ...parts) => {
    const file = openSync(path, flags);
    try {
      for (const part of parts) for (let at = 0; at < part.length; ) at += writeSync(file, part, at);
      fsyncSync(file);
    } finally {
      closeSync(file);
    }
  };
  const readFile = (/** @type {string} */ path) => {
    const [head, ...parts] = unpack(readFileSync(path));
    const values = new Map(head.keys.map((/** @type {string} */ key, /** @type {number} */ i) => [key, parts[i]]));
    return { name: head.name, atMs: head.atMs, values };
  };
  return {
    open(name) {
      const path = join(folder, createHash('sha256').update(name).digest('hex') + END);
      /** @type {{ atMs: number | null, values: Map<string, Uint8Array> } | undefined} */
      let kept;
      const load = () => {
        try {
          kept ??= readFile(path);
        } catch (error) {
          if (/** @type {any} */ (error).code !== 'ENOENT') throw error;
          kept = { atMs: null, values: new Map() };
        }
        return kept;
      };
      const save = (/** @type {Map<string, Uint8Array>} */ values, /** @type {number | null} */ atMs) => {
        synced(`${path}.new`, 'w', pack({ name, atMs, keys: [...values.keys()] }, ...values.values()));
        renameSync(`${path}.new`, path);
        synced(folder, 'r');
        kept = { atMs, values };
      };
      return {
        read: () => load().values,
        write(changes) {
          const { values, atMs } = load();
          const next = new Map(values);
          for (const [key, value] of changes) value ? next.set(key, value) : next.delete(key);
          save(next, atMs);
        },
        clear() {
          rmSync(path, { force: true });
          kept = undefined;
        },
        alarm: () => load().atMs,
        setAlarm: (atMs) => save(load().values, atMs),
      };
    },
    alarms: () =>
      readdirSync(folder)
        .map((file) => readFile(join(folder, file)))
        .filter(({ atMs }) => atMs !== null),
    close() {},
  };
}
