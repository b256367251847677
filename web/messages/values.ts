/** Reading of messages, which may hold anything. */
import { MessageProblem } from './problem.ts';

/** A message or part of one. */
export type Fields = Readonly<Record<string, unknown>>;

export function isFields(value: unknown): value is Fields {
  return typeof value === 'object' && value !== null;
}

/** A part of a message; `name` is for the error. */
export function part(of: Fields, name: string): Fields {
  const value = of[name];
  if (!isFields(value)) throw new MessageProblem('malformed', `the field ${name} is expected to be a message`);
  return value;
}

/** A part of a message by names one inside another. */
export const within = (of: Fields, ...names: readonly string[]): Fields => names.reduce(part, of);

/** A number of a message; NaN where there is none. */
export function numberOf(of: Fields, name: string): number {
  const value = of[name];
  return typeof value === 'number' ? value : typeof value === 'bigint' ? Number(value) : Number.NaN;
}

/** A list in a message: an array or an array of numbers. */
export function listOf(of: Fields, name: string): ArrayLike<unknown> {
  const value = of[name];
  if (Array.isArray(value) || (ArrayBuffer.isView(value) && 'length' in value)) return value as ArrayLike<unknown>;
  throw new MessageProblem('malformed', `the field ${name} is expected to be a list`);
}

/** A time of ROS 1, ROS 2 or Foxglove in seconds; NaN for none, which is zero. */
export function secondsOf(time: unknown): number {
  if (!isFields(time)) return Number.NaN;
  const fraction = 'nsec' in time ? numberOf(time, 'nsec') : numberOf(time, 'nanosec');
  const seconds = numberOf(time, 'sec') + fraction / 1e9;
  return seconds === 0 ? Number.NaN : seconds;
}
