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

/** Whether an error says that what was given is refused. @param {unknown} error */
export const isRefusal = (error) => error instanceof Problem || (isBoresightError(error) && !OURS.has(error.code));

/**
 * What is answered for something thrown; what nobody foresaw is logged and told without its words.
 *
 * @param {unknown} error
 */
export function problemOf(error) {
  if (error instanceof Problem) return error;
  if (isBoresightError(error) && !OURS.has(error.code)) {
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

/** @param {string} what @param {string} expected @param {unknown} given */
export const wrongType = (what, expected, given) =>
  new Problem(422, 'wrong-type', { what, expected, given: given === null ? 'null' : typeof given });
