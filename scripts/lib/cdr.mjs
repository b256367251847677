/** A message in the encoding of ROS 2: CDR, little-endian, numbers at multiples of their size. */
export class Cdr {
  #bytes = Buffer.alloc(256);
  #length = 4;

  constructor() {
    this.#bytes[1] = 1;
  }

  #room(size, count = size) {
    const at = this.#length + ((size - ((this.#length - 4) % size)) % size);
    while (at + count > this.#bytes.length)
      this.#bytes = Buffer.concat([this.#bytes, Buffer.alloc(this.#bytes.length)]);
    this.#length = at + count;
    return at;
  }

  u8(...numbers) {
    for (const number of numbers) this.#bytes[this.#room(1)] = number;
    return this;
  }

  u32(...numbers) {
    for (const number of numbers) {
      const at = this.#room(4);
      this.#bytes.writeUInt32LE(number, at);
    }
    return this;
  }

  f32(...numbers) {
    for (const number of numbers) {
      const at = this.#room(4);
      this.#bytes.writeFloatLE(number, at);
    }
    return this;
  }

  f64(...numbers) {
    for (const number of numbers) {
      const at = this.#room(8);
      this.#bytes.writeDoubleLE(number, at);
    }
    return this;
  }

  bytes(bytes) {
    this.u32(bytes.length);
    const at = this.#room(1, bytes.length);
    this.#bytes.set(bytes, at);
    return this;
  }

  text(text) {
    return this.bytes(Buffer.from(`${text}\0`));
  }

  /** `std_msgs/Header` of a time in ns. */
  header(timeNs, frame) {
    return this.u32(Number(timeNs / 1_000_000_000n), Number(timeNs % 1_000_000_000n)).text(frame);
  }

  done() {
    return new Uint8Array(this.#bytes.subarray(0, this.#length));
  }
}
