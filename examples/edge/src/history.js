const POINTS = 1024;
const EVERY_S = 5;

/** The angle over time in a bounded number of points: where there are too many, every second one goes. */
export class History {
  #rows;
  #everyS;
  /** Whether a point came since it was last kept. */
  changed = false;

  /** @param {{ everyS: number }} [head] @param {Uint8Array<ArrayBuffer>} [rows] */
  constructor(head, rows) {
    this.#everyS = head?.everyS ?? EVERY_S;
    this.#rows = rows ? Array.from(new Float64Array(rows.buffer)) : [];
  }

  /** Whether a point is due. @param {number} timeS */
  due(timeS) {
    // Times jump back where the clock was reset.
    return this.#rows.length === 0 || Math.abs(timeS - (this.#rows.at(-3) ?? 0)) >= this.#everyS;
  }

  /** @param {number} timeS @param {{ angleDeg: number, sigmaDeg: number }} estimate */
  add(timeS, { angleDeg, sigmaDeg }) {
    if (this.#rows.length >= 3 * POINTS) {
      this.#rows = this.#rows.filter((_, i) => Math.floor(i / 3) % 2 === 0);
      this.#everyS *= 2;
    }
    this.#rows.push(timeS, angleDeg, sigmaDeg);
    this.changed = true;
  }

  get head() {
    return { everyS: this.#everyS };
  }

  get bytes() {
    return new Uint8Array(Float64Array.from(this.#rows).buffer);
  }

  toJSON() {
    const column = (/** @type {number} */ k) => this.#rows.filter((_, i) => i % 3 === k);
    return { timeS: column(0), angleDeg: column(1), sigmaDeg: column(2) };
  }
}
