import { together } from './together.js';

/** SQLite in one file: that of Node from 22.13 on, of Deno, and of Bun, which differ in their names alone. */

const SCHEMA = `
  PRAGMA journal_mode = WAL;
  PRAGMA synchronous = FULL;
  CREATE TABLE IF NOT EXISTS kept (name TEXT, key TEXT, value BLOB, PRIMARY KEY (name, key)) WITHOUT ROWID;
  CREATE TABLE IF NOT EXISTS alarms (name TEXT PRIMARY KEY, at_ms REAL) WITHOUT ROWID;
`;

/** @param {string} path @returns {Promise<any>} undefined where the runtime has no SQLite */
async function opened(path) {
  if ('Bun' in globalThis) return new (await import('bun:sqlite')).Database(path);
  const sqlite = await import('node:sqlite').catch(() => undefined);
  return sqlite && new sqlite.DatabaseSync(path);
}

/**
 * @param {string} path
 * @param {typeof opened} [open] which tests replace
 * @returns {Promise<import('./storage.js').Database | undefined>}
 */
export async function openSqlite(path, open = opened) {
  const db = await open(path);
  if (!db) return undefined;
  db.exec(SCHEMA);
  const read = db.prepare('SELECT key, value FROM kept WHERE name = ?');
  const put = db.prepare('INSERT OR REPLACE INTO kept VALUES (?, ?, ?)');
  const take = db.prepare('DELETE FROM kept WHERE name = ? AND key = ?');
  const clear = db.prepare('DELETE FROM kept WHERE name = ?');
  const alarms = db.prepare('SELECT name, at_ms AS atMs FROM alarms');
  const alarm = db.prepare('SELECT at_ms AS atMs FROM alarms WHERE name = ?');
  const setAlarm = db.prepare('INSERT OR REPLACE INTO alarms VALUES (?, ?)');
  const clearAlarm = db.prepare('DELETE FROM alarms WHERE name = ?');
  const commit = together((/** @type {(() => void)[]} */ writes) => {
    try {
      db.exec('BEGIN IMMEDIATE');
      for (const write of writes) write();
      db.exec('COMMIT');
    } catch (error) {
      try {
        db.exec('ROLLBACK');
      } catch {
        // Where the disk is full, SQLite has already rolled back.
      }
      throw error;
    }
  });
  return {
    open: (name) => ({
      read: () => new Map(read.all(name).map((/** @type {any} */ row) => [row.key, row.value])),
      write: (changes) =>
        commit(() => {
          for (const [key, value] of changes) value ? put.run(name, key, value) : take.run(name, key);
        }),
      clear: () =>
        commit(() => {
          clear.run(name);
          clearAlarm.run(name);
        }),
      alarm: () => alarm.get(name)?.atMs ?? null,
      setAlarm: (atMs) => commit(() => setAlarm.run(name, atMs)),
    }),
    alarms: () => alarms.all(),
    unreadable: new Map(),
    isUnreadable: () => false,
  };
}
