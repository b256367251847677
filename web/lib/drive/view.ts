// The parts of a drive, checked: drives come from anywhere.
import { failure, own, reading, wrong } from '../runtime/errors.js';
import { isArray, type Kind, typedArray } from '../runtime/given.js';
import type { DriveData, DriveSensor, MotionGap } from '../types.js';

export type Floats = Float32Array | Float64Array;

/** Most detections of a scan. */
const MOST_DETECTIONS = 65_535;
const MAX_GAP_S = 0.25;

/** A drive of which types and lengths are right; what its times and offsets say is checked where they are used. */
export interface View {
  sensors: DriveSensor[];
  timeS: Float64Array;
  sensor: Uint8Array;
  offsets: Uint32Array;
  azimuthDeg: Floats;
  rangeRateMps: Floats;
  rangeM: Floats | undefined;
  rcsDbsm: Floats | undefined;
  label: Uint8Array | undefined;
  motion: { timeS: Float64Array; yawRateDegps: Floats; speedMps: Floats | undefined };
}

/** Reads the fields of an object, each once. */
export class Reader {
  readonly #object: object;
  readonly #path: string;

  constructor(value: unknown, path: string) {
    if (typeof value !== 'object' || value === null || isArray(value)) throw wrong(path, 'an object', value);
    this.#object = value;
    this.#path = path;
  }

  path(name: string): string {
    return `${this.#path}.${name}`;
  }

  /** The value of a field; undefined for null too. */
  get(name: string): unknown {
    return reading(this.path(name), () => (this.#object as Record<string, unknown>)[name] ?? undefined);
  }

  part(name: string): Reader {
    return new Reader(this.get(name), this.path(name));
  }

  /** A typed array of one of these kinds, of a length unless that is its own; undefined if absent. */
  maybe<T extends { length: number }>(name: string, kinds: readonly Kind<T>[], length?: number): T | undefined {
    const value = this.get(name);
    if (value === undefined) return undefined;
    const array = typedArray(value, kinds);
    if (!array) throw wrong(this.path(name), `a ${kinds.map((kind) => kind.name).join(' or ')}`, value);
    if (length !== undefined && array.length !== length) {
      throw failure('shape', { what: this.path(name), expected: `${length} entries`, given: `${array.length}` });
    }
    return array;
  }

  array<T extends { length: number }>(name: string, kinds: readonly Kind<T>[], length?: number): T {
    const array = this.maybe(name, kinds, length);
    if (array !== undefined) return array;
    const expected = `a ${kinds.map((kind) => kind.name).join(' or ')}`;
    throw failure('missing', { what: this.path(name), expected, given: 'nothing' });
  }
}

export const floats: readonly Kind<Floats>[] = [Float64Array, Float32Array];

/** Numbers in double precision. */
export const doubles = (values: Floats): Float64Array =>
  values instanceof Float64Array ? values : Float64Array.from(values);

/** The parts of a drive; throws where a type or a length is wrong. */
export function viewOf(drive: DriveData): View {
  const root = new Reader(drive, 'drive');
  const [scans, detections] = [root.part('scans'), root.part('detections')];
  const timeS = scans.array('timeS', [Float64Array]);
  const azimuthDeg = detections.array('azimuthDeg', floats);
  const count = azimuthDeg.length;
  return {
    sensors: sensorsOf(root.get('sensors')),
    timeS,
    sensor: scans.array('sensor', [Uint8Array], timeS.length),
    offsets: scans.array('offsets', [Uint32Array], timeS.length + 1),
    azimuthDeg,
    rangeRateMps: detections.array('rangeRateMps', floats, count),
    rangeM: detections.maybe('rangeM', floats, count),
    rcsDbsm: detections.maybe('rcsDbsm', floats, count),
    label: detections.maybe('label', [Uint8Array], count),
    motion: motionOf(root.part('motion')),
  };
}

/** The car's motion as measured. */
export function motionOf(motion: Reader): View['motion'] {
  const timeS = motion.array('timeS', [Float64Array]);
  return {
    timeS,
    yawRateDegps: motion.array('yawRateDegps', floats, timeS.length),
    speedMps: motion.maybe('speedMps', floats, timeS.length),
  };
}

function sensorsOf(value: unknown): DriveSensor[] {
  const items = reading('drive.sensors', () => (isArray(value) && value.length <= 256 ? Array.from(value) : undefined));
  if (!items) throw wrong('drive.sensors', 'an array of at most 256 radars', value);
  const sensors = items.map((item, index): DriveSensor => {
    const fields = new Reader(item, `drive.sensors[${index}]`);
    const number = (name: string): number | null => {
      const given = fields.get(name) ?? null;
      if (given !== null && !Number.isFinite(given)) throw wrong(fields.path(name), 'a finite number or null', given);
      return given as number | null;
    };
    const id = fields.get('id');
    if (typeof id !== 'number' || !(id >= 0 && id <= 255 && Number.isInteger(id))) {
      throw wrong(fields.path('id'), 'a whole number from 0 to 255', id);
    }
    return { id, xM: number('xM'), yM: number('yM'), yawDeg: number('yawDeg') };
  });
  const ids = sensors.map(({ id }) => id);
  const twice = ids.find((id, index) => ids.indexOf(id) !== index);
  if (twice !== undefined)
    throw failure('out-of-range', { what: 'drive.sensors', expected: 'each number once', given: `${twice}` });
  return sensors;
}

/** Throws where times are no numbers or run backwards, or offsets do not ascend to the number of detections. */
export function checkOrder(view: View): void {
  ascending('drive.scans.timeS', view.timeS);
  ascending('drive.motion.timeS', view.motion.timeS);
  for (let scan = 0; scan < view.timeS.length; scan++) extent(view, scan);
}

/** Throws where times are no numbers or run backwards. */
export function ascending(what: string, times: Floats): void {
  let previous = -Infinity;
  for (const [index, given] of times.entries()) {
    if (!Number.isFinite(given)) {
      throw failure('not-finite', { what, expected: 'finite numbers', given: `${given} at index ${index}` });
    }
    if (given < previous) {
      throw failure('time-backwards', {
        what,
        expected: `at least ${previous} s`,
        given: `${given} s at index ${index}`,
      });
    }
    previous = given;
  }
}

/** Where the detections of a scan begin and end. */
export function extent(view: View, scan: number): [start: number, end: number] {
  const [start, end] = [view.offsets[scan] ?? NaN, view.offsets[scan + 1] ?? NaN];
  // A report may have given one of them away since.
  const count = Math.min(view.azimuthDeg.length, view.rangeRateMps.length);
  if (start <= end && end <= count && end - start <= MOST_DETECTIONS) return [start, end];
  throw failure('out-of-range', {
    what: 'drive.scans.offsets',
    expected: `ascending to at most ${count}, by at most ${MOST_DETECTIONS}`,
    given: `${start}, ${end} at index ${scan}`,
  });
}

/** A positive number of an option. */
export function positive(what: string, given: unknown): number {
  if (typeof given === 'number' && given > 0) return given;
  throw wrong(what, 'a number greater than 0', given);
}

/** The longest gap that is bridged. */
export function gapOf(gap: MotionGap | undefined): number {
  return positive('maxGapS', own(gap ?? undefined, 'gap').maxGapS ?? MAX_GAP_S);
}

/**
 * The scans of some radars in arrays of their own, with what calibration reads, and their numbers in the drive; ranges and
 * cross-sections where it is asked for as a whole.
 */
export function selected(
  drive: DriveData,
  ids: readonly number[],
  whole: boolean,
): { drive: DriveData; scans: Uint32Array } {
  const view = viewOf(drive);
  checkOrder(view);
  const scans = scansOf(view, ids);
  const extents = Array.from(scans, (scan) => extent(view, scan));
  const offsets = new Uint32Array(scans.length + 1);
  extents.forEach(([start, end], index) => (offsets[index + 1] = (offsets[index] ?? 0) + end - start));
  const gathered = <T extends Floats>(from: T): T => {
    const values = from.slice(0, 0).constructor as new (length: number) => T;
    const own = new values(offsets[scans.length] ?? 0);
    // Scans whose detections follow each other are copied together: those of a drive with one radar at once.
    for (let first = 0; first < extents.length; ) {
      const [start, end] = extents[first] as [number, number];
      let last = first;
      let until = end;
      while (extents[last + 1]?.[0] === until) until = (extents[++last] as [number, number])[1];
      own.set(from.subarray(start, until), offsets[first]);
      first = last + 1;
    }
    return own;
  };
  const { timeS, yawRateDegps, speedMps } = view.motion;
  const part: DriveData = {
    sensors: view.sensors.filter(({ id }) => ids.includes(id)),
    scans: {
      timeS: Float64Array.from(scans, (scan) => view.timeS[scan] ?? NaN),
      sensor: Uint8Array.from(scans, (scan) => view.sensor[scan] ?? 0),
      offsets,
    },
    detections: {
      azimuthDeg: gathered(view.azimuthDeg),
      rangeRateMps: gathered(view.rangeRateMps),
      rangeM: whole && view.rangeM ? gathered(view.rangeM) : null,
      rcsDbsm: whole && view.rcsDbsm ? gathered(view.rcsDbsm) : null,
    },
    motion: { timeS: timeS.slice(), yawRateDegps: yawRateDegps.slice(), speedMps: speedMps?.slice() ?? null },
  };
  return { drive: part, scans };
}

/** Numbers of the scans of some radars. */
export function scansOf(view: View, ids: readonly number[]): Uint32Array {
  const wanted = new Uint8Array(256);
  for (const id of ids) wanted[id] = 1;
  const scans = new Uint32Array(view.sensor.reduce((count, id) => count + (wanted[id] ?? 0), 0));
  let next = 0;
  for (const [scan, id] of view.sensor.entries()) if (wanted[id]) scans[next++] = scan;
  return scans;
}
