/** Bodies, read in pieces that come within a time and up to a size. */
import { Problem } from './reply.js';

const TICK = Symbol('the time is over');

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
  let whole = false;
  try {
    for (;;) {
      /** @type {ReturnType<typeof setTimeout> | undefined} */
      let timer;
      const late = new Promise((resolve) => {
        timer = setTimeout(resolve, idleS * 1000, TICK);
      });
      const reading = reader.read();
      const read = await Promise.race([reading, late]).catch(() => {
        throw new Problem(400, 'cut', { what: 'the body', expected: 'all of it', given: 'cut short' });
      });
      clearTimeout(timer);
      if (read === TICK) {
        reading.catch(() => {});
        const details = { what: 'the body', expected: `a piece every ${idleS} s`, given: 'none' };
        throw new Problem(408, 'too-slow', details, { headers: { connection: 'close' } });
      }
      const { done, value } = /** @type {ReadableStreamReadResult<Uint8Array>} */ (read);
      if (done) {
        whole = true;
        return;
      }
      yield value;
    }
  } finally {
    if (!whole) reader.cancel().catch(() => {});
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
