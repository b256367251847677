/** The user's own array calibrations: read from files or made here. */
import { signal } from '@preact/signals';
import type { ArrayCalibration } from 'boresight';
import { digest } from '../../../session/digest.ts';

export interface OwnCalibration {
  /** What the state names it by: the first digits of its file's digest. */
  id: string;
  /** Of its file. */
  name: string;
  file: File;
  value: ArrayCalibration;
}

export const ownCalibrations = signal<readonly OwnCalibration[]>([]);

/** How many are kept; the oldest goes. */
const MOST = 20;
const DIGITS = 8;
const UNKNOWN = '0'.repeat(DIGITS);

/** What a file of a calibration is called, after what it was made from. */
export const calibrationName = (of: string): string =>
  `${of.replace(/(\.calibration)?\.\w+$/i, '') || 'array'}.calibration.json`;

/** A name that none of the others has. */
function unlike(others: readonly OwnCalibration[], name: string): string {
  let free = name;
  for (let number = 2; others.some((one) => one.name === free); number++)
    free = name.replace(/(\.calibration\.json)$/, `-${number}$1`);
  return free;
}

/** Keeps a calibration, in place of one that is the same. */
export async function keep(value: ArrayCalibration, name: string): Promise<OwnCalibration> {
  const bytes = new TextEncoder().encode(`${JSON.stringify(value, null, 2)}\n`);
  const id = (await digest(bytes))?.slice(0, DIGITS) ?? UNKNOWN;
  const others = ownCalibrations.peek().filter((one) => one.id !== id);
  const free = unlike(others, name);
  const own = { id, name: free, file: new File([bytes], free, { type: 'application/json' }), value };
  ownCalibrations.value = [...others, own].slice(-MOST);
  return own;
}

/** Of a state's setting: an own calibration's id. */
export const idOf = (setting: string): string | null => /^own:([0-9a-f]{8})$/.exec(setting)?.[1] ?? null;

/** The own calibration that a setting names, if it is here. */
export const ownOf = (setting: string): OwnCalibration | undefined => {
  const id = idOf(setting);
  return id === null ? undefined : ownCalibrations.value.find((one) => one.id === id);
};
