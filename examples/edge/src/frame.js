/** A frame as a line of JSON. */
import { mixed, SEED } from './digest.js';
import { Problem, wrongType } from './reply.js';

const FIELDS = ['radar', 'timeS', 'azimuthDeg', 'rangeRateMps', 'yawRateDegps', 'speedMps'];

/** What radars and vehicles may be called: 1 to 64 characters of any script, without control characters and slashes. */
export const isName = (/** @type {string} */ name) =>
  /^[^\p{Cc}\p{Cs}\p{Zl}\p{Zp}/]{1,64}$/u.test(name) && name !== '.' && name !== '..';

/** @param {unknown} value @returns {value is Record<string, unknown>} */
export const isObject = (value) => typeof value === 'object' && value !== null && !Array.isArray(value);

/** @param {string} what @param {unknown} value @param {number} limit */
export function numbers(what, value, limit) {
  if (!Array.isArray(value)) throw wrongType(what, 'an array of numbers', value);
  if (value.length > limit) {
    throw new Problem(422, 'too-many', { what, expected: `${limit} numbers at most`, given: `${value.length}` });
  }
  const strange = value.findIndex((item) => typeof item !== 'number');
  if (strange >= 0) throw wrongType(`${what}[${strange}]`, 'a number', value[strange]);
  return Float64Array.from(/** @type {number[]} */ (value));
}

/** @param {string} what @param {unknown} value */
function number(what, value) {
  if (typeof value !== 'number') throw wrongType(what, 'a number', value);
  return value;
}

/**
 * The frame that a value is, and its radar where it names one.
 *
 * @param {unknown} value
 * @param {{ detections: number }} limits
 */
export function frameOf(value, { detections }) {
  if (!isObject(value)) throw wrongType('frame', 'an object', value);
  const unknown = Object.keys(value).find((name) => !FIELDS.includes(name));
  if (unknown !== undefined) {
    const details = { what: `frame.${unknown.slice(0, 64)}`, expected: FIELDS.join(', '), given: 'an unknown field' };
    throw new Problem(422, 'unknown-field', details);
  }
  const { radar, timeS, azimuthDeg, rangeRateMps, yawRateDegps, speedMps } = value;
  return {
    radar: typeof radar === 'number' ? String(radar) : radar,
    frame: {
      timeS: number('frame.timeS', timeS),
      azimuthDeg: numbers('frame.azimuthDeg', azimuthDeg, detections),
      rangeRateMps: numbers('frame.rangeRateMps', rangeRateMps, detections),
      yawRateDegps: yawRateDegps === null ? null : number('frame.yawRateDegps', yawRateDegps),
      speedMps: speedMps === undefined || speedMps === null ? null : number('frame.speedMps', speedMps),
    },
  };
}

/**
 * A hash of a frame's numbers. Frames that were sent again have the same one.
 *
 * @param {import('boresight').CalibrationFrame} frame
 */
export function digestOf({ timeS, azimuthDeg, rangeRateMps, yawRateDegps, speedMps }) {
  const rest = Float64Array.of(timeS, yawRateDegps ?? Number.NaN, speedMps ?? Number.NaN, azimuthDeg.length);
  return [rest, azimuthDeg, rangeRateMps].reduce(
    (digest, { buffer, byteOffset, byteLength }) => mixed(digest, new Uint32Array(buffer, byteOffset, byteLength / 4)),
    SEED,
  );
}
