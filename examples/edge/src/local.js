/** Objects by name in one process, as Durable Objects are on their platform: made when asked, put to rest when idle, woken by alarms. */

const IDLE_MS = 10_000;
/** After this, an alarm that failed is tried again. */
const RETRY_MS = 60_000;
/** Longest wait that a timer takes. */
const LONGEST_MS = 2 ** 31 - 1;

/**
 * @template {{ rest(): void, alarm(): void | Promise<void>, quarantined: string | null }} T
 */
export class Objects {
  /** Names of those whose stored data could not be read when they were last used. @type {Set<string>} */
  quarantined = new Set();
  #database;
  #prefix;
  #make;
  /** @type {Map<string, { object: T, running: number, idle?: ReturnType<typeof setTimeout> }>} */
  #live = new Map();

  /**
   * @param {import('./storage/storage.js').Database} database
   * @param {string} prefix of their names in it
   * @param {(storage: import('./storage/storage.js').Storage) => T} make
   */
  constructor(database, prefix, make) {
    this.#database = database;
    this.#prefix = prefix;
    this.#make = make;
    for (const { name, atMs } of database.alarms()) {
      if (name.startsWith(prefix)) this.#wake(name.slice(prefix.length), atMs);
    }
  }

  /**
   * Does something with an object, which stays meanwhile.
   *
   * @template R
   * @param {string} name
   * @param {(object: T) => R | Promise<R>} work
   */
  async use(name, work) {
    const one = this.#live.get(name) ?? { object: this.#make(this.#storageOf(name)), running: 0 };
    this.#live.set(name, one);
    clearTimeout(one.idle);
    one.running += 1;
    try {
      return await work(one.object);
    } finally {
      one.running -= 1;
      if (one.object.quarantined) this.quarantined.add(name);
      else this.quarantined.delete(name);
      if (one.running === 0) one.idle = this.#later(IDLE_MS, () => this.#rest(name));
    }
  }

  /** @param {string} name */
  #rest(name) {
    const one = this.#live.get(name);
    if (!one || one.running > 0) return;
    this.#live.delete(name);
    one.object.rest();
  }

  /** @param {string} name */
  #storageOf(name) {
    const storage = this.#database.open(this.#prefix + name);
    return {
      ...storage,
      setAlarm: async (/** @type {number} */ atMs) => {
        await storage.setAlarm(atMs);
        this.#wake(name, atMs);
      },
    };
  }

  /** @param {string} name @param {number} atMs */
  #wake(name, atMs, waitMs = atMs - Date.now()) {
    this.#later(Math.min(LONGEST_MS, Math.max(0, waitMs)), async () => {
      try {
        const setMs = await this.#database.open(this.#prefix + name).alarm();
        // Taken away, or set for another time.
        if (setMs !== atMs) return;
        if (Date.now() < atMs) this.#wake(name, atMs);
        else await this.use(name, (object) => object.alarm());
      } catch (error) {
        console.error(error);
        this.#wake(name, atMs, RETRY_MS);
      }
    });
  }

  /** A timer that keeps no process alive. @param {number} ms @param {() => void} work */
  #later(ms, work) {
    const timer = setTimeout(work, ms);
    /** @type {any} */ (timer).unref?.();
    return timer;
  }
}
