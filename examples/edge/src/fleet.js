/** The vehicles of a tenant, as each told last: for lists and metrics, which ask no vehicle. */
import { pack, unpack } from './storage/pack.js';

/** @typedef {{ receivedMs: number, refused: Record<string, number>, radars: import('./radar.js').Summary[] }} Told */

export class Fleet {
  #storage;
  /** @type {Map<string, Told> | undefined} */
  #told;

  /** @param {import('./storage/storage.js').Storage} storage */
  constructor(storage) {
    this.#storage = storage;
  }

  #load() {
    this.#told ??= new Map(Array.from(this.#storage.read(), ([vehicle, bytes]) => [vehicle, unpack(bytes)[0]]));
    return this.#told;
  }

  /** Whether a tenant may have this vehicle. @param {string} vehicle @param {number} most */
  async admit(vehicle, most) {
    const told = this.#load();
    if (!told.has(vehicle) && told.size >= most) return false;
    if (!told.has(vehicle)) await this.tell(vehicle, { receivedMs: Date.now(), refused: {}, radars: [] });
    return true;
  }

  /** @param {string} vehicle @param {Told} told */
  tell(vehicle, told) {
    this.#load().set(vehicle, told);
    return this.#storage.write([[vehicle, pack(told)]]);
  }

  /** @param {string} vehicle */
  forget(vehicle) {
    this.#load().delete(vehicle);
    return this.#storage.write([[vehicle, null]]);
  }

  vehicles() {
    return Array.from(this.#load(), ([vehicle, told]) => ({ vehicle, ...told }));
  }

  rest() {
    this.#told = undefined;
  }

  alarm() {}
}
