/** The vehicles of a tenant, as each told last: for lists and metrics, which ask no vehicle. */
import { unreadable } from './reply.js';
import { pack, unpack } from './storage/pack.js';

/** How long a place is held for a vehicle that was admitted and has not reported. */
const HELD_MS = 60_000;

/** @typedef {{ receivedMs: number, refused: Record<string, number>, radars: import('./radar.js').Summary[], quarantined?: string }} Told */

export class Fleet {
  #storage;
  /** @type {Map<string, Told> | undefined} */
  #told;
  /** Vehicles that were admitted and are not stored yet, with the end of their wait. @type {Map<string, number>} */
  #admitted = new Map();
  /** Code of what is wrong with the stored data. @type {string | null} */
  quarantined = null;

  /** @param {import('./storage/storage.js').Storage} storage */
  constructor(storage) {
    this.#storage = storage;
  }

  #load() {
    try {
      this.#told ??= new Map(Array.from(this.#storage.read(), ([vehicle, bytes]) => [vehicle, unpack(bytes)[0]]));
    } catch (error) {
      const problem = unreadable('the list of vehicles', error);
      if (!this.quarantined) console.error(problem.message);
      this.quarantined = problem.code;
      throw problem;
    }
    this.quarantined = null;
    return this.#told;
  }

  /** Whether a tenant may have this vehicle. It is listed when it is stored. @param {string} vehicle @param {number} most */
  async admit(vehicle, most) {
    const told = this.#load();
    if (told.has(vehicle)) return true;
    const nowMs = Date.now();
    for (const [name, untilMs] of this.#admitted) if (untilMs <= nowMs) this.#admitted.delete(name);
    if (!this.#admitted.has(vehicle) && told.size + this.#admitted.size >= most) return false;
    this.#admitted.set(vehicle, nowMs + HELD_MS);
    return true;
  }

  /** @param {string} vehicle @param {Told} told */
  tell(vehicle, told) {
    this.#load().set(vehicle, told);
    this.#admitted.delete(vehicle);
    return this.#storage.write([[vehicle, pack(told)]]);
  }

  /** Marks a vehicle whose stored data cannot be read; what it told last stays. @param {string} vehicle @param {string} code */
  async quarantine(vehicle, code) {
    const before = this.#load().get(vehicle) ?? { receivedMs: Date.now(), refused: {}, radars: [] };
    if (before.quarantined !== code) await this.tell(vehicle, { ...before, quarantined: code });
  }

  /** Whether the vehicle was listed. @param {string} vehicle */
  async forget(vehicle) {
    const told = this.#load();
    const before = told.get(vehicle);
    this.#admitted.delete(vehicle);
    if (!before) return false;
    told.delete(vehicle);
    try {
      await this.#storage.write([[vehicle, null]]);
    } catch (error) {
      if (!told.has(vehicle)) told.set(vehicle, before);
      throw error;
    }
    return true;
  }

  vehicles() {
    return Array.from(this.#load(), ([vehicle, told]) => ({ vehicle, ...told }));
  }

  rest() {
    this.#told = undefined;
  }

  alarm() {}
}
