/** The SQLite of a Durable Object, which holds answers back until what was written before them is on disk. */

const TABLE = 'CREATE TABLE IF NOT EXISTS kept (key TEXT PRIMARY KEY, value BLOB) WITHOUT ROWID';

/** @param {{ storage: any }} context @returns {import('./storage.js').Storage} */
export function durableStorage({ storage }) {
  const { sql } = storage;
  return {
    read() {
      sql.exec(TABLE);
      return new Map(
        [...sql.exec('SELECT key, value FROM kept')].map(({ key, value }) => [key, new Uint8Array(value)]),
      );
    },
    write: (changes) =>
      storage.transactionSync(() => {
        sql.exec(TABLE);
        for (const [key, value] of changes) {
          if (value) sql.exec('INSERT OR REPLACE INTO kept VALUES (?, ?)', key, value);
          else sql.exec('DELETE FROM kept WHERE key = ?', key);
        }
      }),
    clear() {
      storage.deleteAlarm();
      storage.deleteAll();
    },
    alarm: () => storage.getAlarm(),
    setAlarm: (atMs) => storage.setAlarm(atMs),
  };
}
