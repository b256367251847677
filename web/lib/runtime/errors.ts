import { describe, isArray } from './given.js';

/** What was wrong, what would have been accepted and what was given. */
export interface ErrorDetails {
  readonly what: string;
  readonly expected: string;
  readonly given: string;
}

/** An error as it crosses a boundary where classes are lost: out of wasm, out of a worker. */
export interface PlainError extends ErrorDetails {
  readonly code: string;
  readonly message: string;
}

/** The one error this package throws. `code` is stable and meant for programs. */
export class BoresightError extends Error {
  override readonly name = 'BoresightError';
  readonly code: string;
  readonly details: ErrorDetails;

  constructor(code: string, message: string, details: ErrorDetails, options?: ErrorOptions) {
    super(message, options);
    this.code = code;
    this.details = details;
  }

  /** The error again, on the other side of a boundary. */
  static fromPlain({ code, message, what, expected, given }: PlainError): BoresightError {
    return new BoresightError(code, message, { what, expected, given });
  }

  /** Code, message and details alone, which any boundary lets through. */
  toPlain(): PlainError {
    return { code: this.code, message: this.message, ...this.details };
  }

  /** What `JSON.stringify` shows. */
  toJSON(): PlainError {
    return this.toPlain();
  }
}

/** Whether a thrown value is an error of the bindings. */
export function isPlainError(thrown: unknown): thrown is PlainError {
  return (
    typeof thrown === 'object' && thrown !== null && !(thrown instanceof Error) && 'code' in thrown && 'what' in thrown
  );
}

/** An error made on this side of the boundary; its message is put together from the details. */
export function failure(code: string, details: ErrorDetails, cause?: unknown): BoresightError {
  const { what, expected, given } = details;
  const message = `${what} is ${given}; expected ${expected}`;
  return new BoresightError(code, message, details, cause === undefined ? undefined : { cause });
}

/** For a value of another type than expected. */
export function wrong(what: string, expected: string, value: unknown): BoresightError {
  return failure('wrong-type', { what, expected, given: describe(value) });
}

/** Reads arguments; what they throw by themselves becomes a typed error that names them. */
export function reading<T>(what: string, read: () => T): T {
  try {
    return read();
  } catch (cause) {
    if (cause instanceof BoresightError) throw cause;
    throw failure('wrong-type', { what, expected: 'a value', given: 'a property that throws' }, cause);
  }
}

/** A copy of options; none of them where there are no options. Others than those of `names` are refused where they are given. */
export function own<T extends object>(
  options: T | undefined,
  what: string,
  names?: readonly (keyof T & string)[],
): { [K in keyof T]?: unknown } {
  if (options === undefined) return {};
  if (typeof options !== 'object' || options === null || isArray(options)) throw wrong(what, 'an object', options);
  const copy = reading(what, () => ({ ...options }));
  const other = names && Object.keys(copy).find((name) => !names.includes(name as keyof T & string));
  if (names && other !== undefined)
    throw failure('unknown-option', { what: `${what}.${other}`, expected: names.join(', '), given: 'another name' });
  return copy;
}
