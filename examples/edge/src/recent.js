const FRAMES = 1024;

/** The last frames of a radar by time and digest: tells a frame that is sent again from one that comes too late. */
export class Recent {
  #timeS = new Float64Array(FRAMES).fill(Number.NaN);
  #digest = new Uint32Array(2 * FRAMES);
  #next = 0;

  /** @param {{ next: number }} [head] @param {Uint8Array<ArrayBuffer>} [timeS] @param {Uint8Array<ArrayBuffer>} [digest] */
  constructor(head, timeS, digest) {
    if (!head || !timeS || !digest) return;
    this.#next = head.next;
    this.#timeS = new Float64Array(timeS.buffer);
    this.#digest = new Uint32Array(digest.buffer);
  }

  /** @param {number} timeS @param {[number, number]} digest */
  has(timeS, [a, b]) {
    for (let i = this.#timeS.indexOf(timeS); i >= 0; i = this.#timeS.indexOf(timeS, i + 1)) {
      if (this.#digest[2 * i] === a && this.#digest[2 * i + 1] === b) return true;
    }
    return false;
  }

  /** @param {number} timeS @param {[number, number]} digest */
  add(timeS, digest) {
    this.#timeS[this.#next] = timeS;
    this.#digest.set(digest, 2 * this.#next);
    this.#next = (this.#next + 1) % FRAMES;
  }

  get head() {
    return { next: this.#next };
  }

  get parts() {
    return [new Uint8Array(this.#timeS.buffer), new Uint8Array(this.#digest.buffer)];
  }
}
