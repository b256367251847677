/** What is answered: JSON, and problems with the parts that boresight's errors have. */

/** An answer other than what was asked for. `also` is put beside code, message and details. */
export class Problem extends Error {
  /**
   * @param {number} status
   * @param {string} code
   * @param {{ what: string, expected: string, given: string }} details
   * @param {{ headers?: Record<string, string>, also?: Record<string, unknown>, message?: string }} [more]
   */
  constructor(status, code, details, { headers = {}, also = {}, message } = {}) {
    super(message ?? `${details.what} is ${details.given}; expected ${details.expected}`);
    this.status = status;
    this.code = code;
    this.details = details;
    this.headers = headers;
    this.also = also;
  }

  toJSON() {
    return { code: this.code, message: this.message, details: this.details, ...this.also };
  }
}

/** Codes of boresight that are not the caller's doing. */
const OURS = new Set(['trap', 'not-loaded', 'not-initialised', 'handle-stale', 'handle-freed', 'handle-busy']);

/** @param {unknown} error @returns {error is import('boresight').BoresightError} */
export const isBoresightError = (error) => error instanceof Error && error.name === 'BoresightError';

/** Whether an error is a fault of the process, which passes, and says nothing of what was given. @param {unknown} error */
export const isOurs = (error) => isBoresightError(error) && OURS.has(error.code);

/** Whether an error says that what was given is refused. @param {unknown} error */
export const isRefusal = (error) => error instanceof Problem || (isBoresightError(error) && !isOurs(error));

/**
 * What is answered for something thrown; what nobody foresaw is logged and told without its words.
 *
 * @param {unknown} error
 */
export function problemOf(error) {
  if (error instanceof Problem) return error;
  if (isBoresightError(error) && !isOurs(error)) {
    return new Problem(422, error.code, { ...error.details }, { message: error.message });
  }
  console.error(error);
  return new Problem(500, 'internal', { what: 'the service', expected: 'to answer', given: 'a fault of its own' });
}

/** Typed arrays as lists; what is not finite is null, as JSON has it. @param {unknown} value */
export const text = (value) =>
  JSON.stringify(value, (_, part) => (ArrayBuffer.isView(part) ? Array.from(/** @type {any} */ (part)) : part));

/** @param {unknown} value @param {number} [status] @param {Record<string, string>} [headers] */
export function json(value, status = 200, headers = {}) {
  const bytes = new TextEncoder().encode(text(value));
  const all = { 'content-type': 'application/json', 'content-length': String(bytes.length), ...headers };
  return new Response(bytes, { status, headers: all });
}

/** @param {unknown} error */
export function refusal(error) {
  const problem = problemOf(error);
  return json(problem, problem.status, problem.headers);
}

/** @param {unknown} value */
function typeOf(value) {
  if (value === null) return 'null';
  if (value === undefined) return 'missing';
  if (Array.isArray(value)) return 'an array';
  return typeof value === 'object' ? 'an object' : `a ${typeof value}`;
}

/** @param {string} what @param {string} expected @param {unknown} given */
export const wrongType = (what, expected, given) =>
  new Problem(422, 'wrong-type', { what, expected, given: typeOf(given) });

/** A fault of the storage; the caller is to send it again later. */
export const notStored = () =>
  new Problem(503, 'not-stored', { what: 'the storage', expected: 'to take it', given: 'failing' });

/**
 * What is answered where stored data cannot be read. It is left as it is, for whoever runs the service to restore.
 *
 * @param {string} what
 * @param {unknown} error
 */
export function unreadable(what, error) {
  const reason = error instanceof Error ? error.message : String(error);
  const newer = isBoresightError(error) && error.code === 'unsupported-snapshot';
  const expected = newer ? 'data of a version that this service reads' : 'what was stored';
  return new Problem(
    503,
    newer ? 'unsupported-snapshot' : 'quarantined',
    { what, expected, given: reason },
    { message: `${what} cannot be read and is quarantined: ${reason}` },
  );
}
