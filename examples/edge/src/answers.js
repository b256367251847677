/** What is worked out at once and forgotten: angles of snapshots, detections of a capture's frame, a mounting angle. */
import { Calibration, Capture, estimate, init, initDrives, setLimits } from 'boresight';
import { bytesOf, checkType, parsed } from './body.js';
import { frameOf, isObject, numbers } from './frame.js';
import { json, Problem, wrongType } from './reply.js';

/** @typedef {import('./config.js').Limits} Limits */

/** Loads what is needed, and gives calls their limits. @param {Limits} limits */
async function ready({ operations, callBytes }) {
  await Promise.all([init(), initDrives()]);
  setLimits({ operations, bytes: callBytes });
}

/** @param {Request} request @param {Limits} limits */
async function jsonOf(request, limits) {
  checkType(request, ['application/json']);
  const value = parsed(await bytesOf(request, limits.bodyBytes, limits.idleS), 'the body');
  if (!isObject(value)) throw wrongType('the body', 'an object', value);
  return value;
}

/** @param {Record<string, unknown>} given @param {string[]} names @param {string} what */
function only(given, names, what) {
  const unknown = Object.keys(given).find((name) => !names.includes(name));
  if (unknown === undefined) return;
  const details = { what: `${what}.${unknown.slice(0, 64)}`, expected: names.join(', '), given: 'an unknown field' };
  throw new Problem(422, 'unknown-field', details);
}

/** @param {string} what @param {unknown} given @returns {import('boresight').ComplexData} */
function complex(what, given) {
  if (!isObject(given)) throw wrongType(what, 'data and shape', given);
  only(given, ['data', 'shape'], what);
  return {
    data: numbers(`${what}.data`, given.data, Number.POSITIVE_INFINITY),
    shape: /** @type {any} */ (given.shape),
  };
}

/** Angles of snapshots or of a covariance. @param {Request} request @param {Limits} limits */
export async function angles(request, limits) {
  const given = await jsonOf(request, limits);
  only(given, ['snapshots', 'covariance', 'snapshotCount', 'options'], 'the body');
  const { snapshots, covariance, snapshotCount, options } = /** @type {any} */ (given);
  await ready(limits);
  const input =
    covariance === undefined
      ? { snapshots: complex('snapshots', snapshots) }
      : { covariance: complex('covariance', covariance), snapshotCount };
  return json(estimate(input, options));
}

/** Detections of a frame of a capture, sent as a form: `capture`, `config`, and perhaps `options`. @param {Request} request @param {Limits} limits */
export async function detections(request, limits) {
  checkType(request, ['multipart/form-data']);
  const bytes = await bytesOf(request, limits.bodyBytes, limits.idleS);
  const form = await new Response(bytes, { headers: { 'content-type': request.headers.get('content-type') ?? '' } })
    .formData()
    .catch(() => {
      throw new Problem(400, 'malformed-form', { what: 'the body', expected: 'a form', given: 'something else' });
    });
  const part = async (/** @type {string} */ name) => {
    const value = form.get(name);
    if (value === null)
      throw new Problem(422, 'missing', { what: name, expected: 'a part of the form', given: 'none' });
    return typeof value === 'string' ? new TextEncoder().encode(value) : new Uint8Array(await value.arrayBuffer());
  };
  const [capture, config] = [await part('capture'), await part('config')];
  const options = form.has('options') ? parsed(await part('options'), 'options') : {};
  if (!isObject(options)) throw wrongType('options', 'an object', options);
  const { frame = 0, ...chain } = options;
  await ready(limits);
  const opened = new Capture(capture, config);
  try {
    return json(opened.processFrame(/** @type {number} */ (frame), chain));
  } finally {
    opened.free();
  }
}

/** The mounting angle of frames that are all here. @param {Request} request @param {Limits} limits */
export async function mountingAngle(request, limits) {
  const given = await jsonOf(request, limits);
  only(given, ['options', 'frames'], 'the body');
  const { options, frames } = /** @type {any} */ (given);
  if (!Array.isArray(frames)) throw wrongType('frames', 'an array of frames', frames);
  const read = frames.map((value) => frameOf(value, limits).frame);
  await ready(limits);
  const calibration = new Calibration(options);
  try {
    for (const frame of read) calibration.addFrame(frame);
    return json({ result: calibration.estimate(), outlook: calibration.outlook() });
  } finally {
    calibration.free();
  }
}
