// Helpers of the tests of the built package.
import assert from 'node:assert/strict';
import { BoresightError } from 'boresight';

/** Asserts that `work` throws a BoresightError with this code whose details name `what`; returns it. */
export function throwsTyped(work, code, what) {
  let thrown;
  assert.throws(work, (error) => {
    thrown = error;
    return isTyped(error, code, what);
  });
  return thrown;
}

/** The same for promises. */
export function rejectsTyped(promise, code, what) {
  return assert.rejects(promise, (error) => isTyped(error, code, what));
}

function isTyped(error, code, what) {
  assert.ok(error instanceof BoresightError, `a BoresightError, not ${error}`);
  if (code !== undefined) assert.equal(error.code, code, error.message);
  assert.notEqual(error.code, code === 'trap' ? '' : 'trap', error.message);
  for (const key of ['what', 'expected', 'given']) {
    assert.equal(typeof error.details[key], 'string', `details.${key} of ${error.message}`);
    assert.notEqual(error.details[key], '', `details.${key} of ${error.message}`);
  }
  if (what !== undefined) assert.equal(error.details.what, what, error.message);
  return true;
}

/** Interleaved snapshots, elements x count, of noiseless plane waves on a half-wavelength array. */
export function planeWaves(elements, count, anglesDeg) {
  const data = new Float64Array(2 * elements * count);
  anglesDeg.forEach((angle, source) => {
    const step = Math.PI * Math.sin((angle * Math.PI) / 180);
    for (let k = 0; k < elements; k++) {
      for (let t = 0; t < count; t++) {
        // Incommensurate rates make the sources uncorrelated over many snapshots.
        const phase = step * k + t * (1 + source) * Math.SQRT2 + source;
        data[2 * (k * count + t)] += Math.cos(phase);
        data[2 * (k * count + t) + 1] += Math.sin(phase);
      }
    }
  });
  return { data, shape: [elements, count] };
}

/** Snapshots of several cells as one batch. */
export function batchOf(cells) {
  const data = new Float64Array(cells.length * cells[0].data.length);
  cells.forEach((cell, c) => data.set(cell.data, c * cell.data.length));
  return { data, shape: [cells.length, ...cells[0].shape] };
}
