/**
 * Serial ports as Web Serial has them, fed by a test. The function stands alone: pages run its text before their own
 * scripts, since no browser without a screen ever answers `requestPort()`.
 */
export function fakeSerial() {
  /** Errors after which a port goes on with another stream. */
  const GOES_ON = ['FramingError', 'ParityError', 'BreakError', 'BufferOverrunError', 'UnknownError'];

  class FakePort extends EventTarget {
    readable = null;
    writable = null;
    plugged = true;
    /** Options of each opening. */
    opened = [];
    closed = 0;
    written = '';
    #queue = [];
    #arrived = null;
    #answer;

    /** `answer` gives what a board says to a line, or null for nothing. */
    constructor(answer = () => null) {
      super();
      this.#answer = answer;
    }

    getInfo() {
      return { usbVendorId: 0x0451, usbProductId: 0xbef3 };
    }

    async open(options) {
      if (this.readable) throw new DOMException('The port is already open.', 'InvalidStateError');
      if (!this.plugged) throw new DOMException('Failed to open serial port.', 'NetworkError');
      this.opened.push(options);
      this.readable = this.#stream();
      this.writable = new WritableStream({ write: (bytes) => this.#take(new TextDecoder().decode(bytes)) });
    }

    async close() {
      if (this.readable?.locked || this.writable?.locked) throw new TypeError('Cannot cancel a locked stream');
      this.closed += 1;
      this.readable = this.writable = null;
    }

    /** Bytes that arrive. */
    feed(bytes) {
      this.#push({ bytes: typeof bytes === 'string' ? new TextEncoder().encode(bytes) : bytes });
    }

    /** An error of the line, after what arrived before it. */
    fail(name) {
      this.#push({ error: name });
    }

    unplug() {
      this.plugged = false;
      this.#push({ error: 'NetworkError' });
    }

    plug() {
      this.plugged = true;
      this.dispatchEvent(new Event('connect'));
    }

    #push(item) {
      this.#queue.push(item);
      this.#arrived?.();
    }

    #stream() {
      return new ReadableStream(
        {
          pull: (controller) => this.#pull(controller),
          cancel: () => this.#arrived?.(),
        },
        { highWaterMark: 0 },
      );
    }

    async #pull(controller) {
      if (this.#queue.length === 0)
        await new Promise((resolve) => {
          this.#arrived = resolve;
        });
      this.#arrived = null;
      // A stream that was cancelled takes nothing.
      if (this.#queue.length === 0) return;
      const { bytes, error } = this.#queue.shift();
      if (bytes) {
        controller.enqueue(bytes);
        return;
      }
      this.readable = GOES_ON.includes(error) ? this.#stream() : null;
      if (!this.readable) this.writable = null;
      controller.error(new DOMException(`${error} on the line.`, error));
      if (!this.readable) this.dispatchEvent(new Event('disconnect'));
    }

    #take(text) {
      this.written += text;
      for (const line of text.split('\n').slice(0, -1)) {
        const said = this.#answer(line, this);
        if (said !== null) this.feed(`${line}\r\n${said}\r\nmmwDemo:/>`);
      }
    }
  }
  return FakePort;
}

/** Bytes of a recording arrive in pieces; `errors` are { at, name, lost }: an error before byte `at`, with the bytes it cost. */
export function feedRecording(port, bytes, { piece = 509, errors = [] } = {}) {
  const breaks = [...errors].sort((a, b) => a.at - b.at);
  let at = 0;
  while (at < bytes.length) {
    const next = breaks[0];
    const end = Math.min(at + piece, next ? next.at : bytes.length, bytes.length);
    if (end > at) port.feed(bytes.slice(at, end));
    at = end;
    if (next && at === next.at) {
      breaks.shift();
      port.fail(next.name);
      at += next.lost ?? 0;
    }
  }
}
