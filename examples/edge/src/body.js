/** Bodies, read in pieces that come within a time and up to a size. */
import { Problem } from './reply.js';

const LATE = Symbol('the time is over');
/** Pieces that are there already are taken together up to so many bytes: what is kept is kept once for all of them. */
const TOGETHER = 1 << 17;

/**
 * What comes within a time, or that it is over.
 *
 * @template T
 * @param {Promise<T>} promise
 * @param {number} ms
 * @returns {Promise<T | typeof LATE>}
 */
function within(promise, ms) {
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;
  const late = new Promise((resolve) => {
    timer = setTimeout(resolve, ms, LATE);
  });
  return Promise.race([promise, late]).finally(() => clearTimeout(timer));
}

/**
 * The pieces of a body as they come.
 *
 * @param {Request} request
 * @param {number} idleS
 * @returns {AsyncGenerator<Uint8Array, void>}
 */
export async function* pieces(request, idleS) {
  const reader = request.body?.getReader();
  if (!reader) return;
  const next = () => {
    const reading = reader.read().catch(() => {
      throw new Problem(400, 'cut', { what: 'the body', expected: 'all of it', given: 'cut short' });
    });
    // What goes wrong is seen when it is asked for, which may be later.
    reading.catch(() => {});
    return reading;
  };
  let reading = next();
  try {
    for (;;) {
      let read = await within(reading, idleS * 1000);
      if (read === LATE) {
        const details = { what: 'the body', expected: `a piece every ${idleS} s`, given: 'none' };
        throw new Problem(408, 'too-slow', details, { headers: { connection: 'close' } });
      }
      const parts = [];
      let length = 0;
      while (read !== LATE && !read.done) {
        parts.push(read.value);
        length += read.value.length;
        reading = next();
        if (length >= TOGETHER) break;
        // An error waits for its turn, after what came before it.
        read = await within(reading, 0).catch(() => LATE);
      }
      if (length > 0) yield joined(parts, length);
      if (read !== LATE && read.done) return;
    }
  } finally {
    reader.cancel().catch(() => {});
  }
}

/**
 * A whole body whose length is told beforehand.
 *
 * @param {Request} request
 * @param {number} limit in bytes
 * @param {number} idleS
 */
export async function bytesOf(request, limit, idleS) {
  const told = request.headers.get('content-length');
  if (told === null) {
    throw new Problem(411, 'length-required', { what: 'Content-Length', expected: 'a length', given: 'none' });
  }
  const tooLarge = (/** @type {string | number} */ given) => {
    const details = { what: 'the body', expected: `${limit} bytes at most`, given: `${given} bytes` };
    return new Problem(413, 'body-too-large', details);
  };
  if (!(Number(told) <= limit)) throw tooLarge(told);
  const parts = [];
  let length = 0;
  for await (const piece of pieces(request, idleS)) {
    length += piece.length;
    if (length > limit) throw tooLarge(`more than ${limit}`);
    parts.push(piece);
  }
  return joined(parts, length);
}

/** @param {Uint8Array[]} parts @param {number} length */
export function joined(parts, length) {
  const bytes = new Uint8Array(length);
  let at = 0;
  for (const part of parts) {
    bytes.set(part, at);
    at += part.length;
  }
  return bytes;
}

/** @param {Uint8Array} bytes @param {string} what @returns {unknown} */
export function parsed(bytes, what) {
  try {
    return JSON.parse(new TextDecoder('utf-8', { fatal: true }).decode(bytes));
  } catch {
    throw new Problem(400, 'malformed-json', { what, expected: 'JSON in UTF-8', given: 'something else' });
  }
}

/** Refuses a body of another type, or one that is packed. @param {Request} request @param {string[]} types */
export function checkType(request, types) {
  const [type = ''] = (request.headers.get('content-type') ?? '').split(';');
  const coding = request.headers.get('content-encoding') ?? 'identity';
  if (!types.includes(type.trim().toLowerCase())) {
    const details = { what: 'Content-Type', expected: types.join(' or '), given: type.trim().slice(0, 100) || 'none' };
    throw new Problem(415, 'unsupported-type', details, { headers: { accept: types.join(', ') } });
  }
  if (coding.toLowerCase() !== 'identity') {
    const details = { what: 'Content-Encoding', expected: 'identity', given: coding.slice(0, 100) };
    throw new Problem(415, 'unsupported-encoding', details, { headers: { 'accept-encoding': 'identity' } });
  }
}
