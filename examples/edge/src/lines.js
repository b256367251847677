const NEWLINE = 10;

/** Lines of a text that comes in pieces cut anywhere; of one that is too long only its number is kept. */
export class Lines {
  #limit;
  #pending = new Uint8Array(4096);
  #length = 0;
  #tooLong = false;
  #number = 0;

  /** @param {number} limit of a line, in bytes */
  constructor(limit) {
    this.#limit = limit;
  }

  /**
   * The lines that end in this piece, with their numbers from 1; without bytes where one is too long.
   *
   * @param {Uint8Array} piece
   */
  push(piece) {
    const lines = [];
    let start = 0;
    for (let end = piece.indexOf(NEWLINE); end >= 0; end = piece.indexOf(NEWLINE, start)) {
      this.#keep(piece.subarray(start, end));
      lines.push(this.#take());
      start = end + 1;
    }
    this.#keep(piece.subarray(start));
    return lines;
  }

  /** What stands after the last newline, where anything does. */
  end() {
    return this.#length > 0 || this.#tooLong ? [this.#take()] : [];
  }

  /** @param {Uint8Array} part */
  #keep(part) {
    const length = this.#length + part.length;
    if (this.#tooLong || length > this.#limit) {
      this.#tooLong = true;
      this.#length = 0;
      return;
    }
    if (length > this.#pending.length) {
      const larger = new Uint8Array(Math.min(this.#limit, Math.max(length, 2 * this.#pending.length)));
      larger.set(this.#pending.subarray(0, this.#length));
      this.#pending = larger;
    }
    this.#pending.set(part, this.#length);
    this.#length = length;
  }

  /** @returns {{ number: number, bytes?: Uint8Array }} */
  #take() {
    this.#number += 1;
    const line = this.#tooLong
      ? { number: this.#number }
      : { number: this.#number, bytes: this.#pending.slice(0, this.#length) };
    this.#length = 0;
    this.#tooLong = false;
    return line;
  }
}
