import { Problem } from './reply.js';

/** A token bucket. What takes more than is left is let through and owed, so that no size is too large for it. */
export class Bucket {
  #perS;
  #burst;
  #left;
  #atMs;

  /** @param {{ perS: number, burst: number }} rate @param {number} nowMs */
  constructor({ perS, burst }, nowMs) {
    this.#perS = perS;
    this.#burst = burst;
    this.#left = burst;
    this.#atMs = nowMs;
  }

  /**
   * Takes so many, or throws where nothing is left.
   *
   * @param {number} count
   * @param {number} nowMs
   * @param {string} what
   */
  take(count, nowMs, what) {
    const passedS = Math.max(0, nowMs - this.#atMs) / 1000;
    this.#left = Math.min(this.#burst, this.#left + passedS * this.#perS);
    this.#atMs = nowMs;
    if (this.#left <= 0) {
      const seconds = Math.ceil((1 - this.#left) / this.#perS);
      const expected = `${this.#perS} a second at most`;
      const headers = { 'retry-after': String(seconds) };
      throw new Problem(429, 'too-many-requests', { what, expected, given: 'more' }, { headers });
    }
    this.#left -= count;
  }
}
