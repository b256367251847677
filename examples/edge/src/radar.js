/** A radar of a vehicle: its calibration, and what became of its frames. */
import { Calibration } from 'boresight';
import { digestOf } from './frame.js';
import { History } from './history.js';
import { Recent } from './recent.js';
import { Problem } from './reply.js';
import { pack, unpack } from './storage/pack.js';

/** Beyond this, s, neighbouring frames have the same time as doubles. */
const LATEST_S = 1e11;

/** @typedef {ReturnType<Radar['summary']>} Summary */

export class Radar {
  #calibration;
  #recent;
  /** @type {import('boresight').CalibrationResult | undefined} */
  #estimate;
  #changed = true;

  /**
   * @param {string} name
   * @param {import('boresight').CalibrationOptions} options
   * @param {Calibration} calibration
   * @param {Recent} recent
   * @param {History} history
   */
  constructor(name, options, calibration, recent, history) {
    this.name = name;
    this.options = options;
    this.#calibration = calibration;
    this.#recent = recent;
    this.history = history;
    /** @type {number | null} */
    this.timeS = null;
    this.frames = 0;
    this.detections = 0;
    this.repeated = 0;
    /** @type {Record<string, number>} */
    this.refused = {};
  }

  /** @param {string} name @param {import('boresight').CalibrationOptions} options */
  static begin(name, options) {
    return new Radar(name, options, new Calibration(options), new Recent(), new History());
  }

  /** The radar that {@link kept} was of. @param {string} name @param {Uint8Array} state @param {Uint8Array} [history] */
  static restore(name, state, history) {
    const [{ options, recent, ...counts }, snapshot = new Uint8Array(), ...frames] = unpack(state);
    const points = history ? new History(...unpack(history)) : new History();
    const radar = new Radar(name, options, Calibration.restore(snapshot), new Recent(recent, ...frames), points);
    radar.#changed = false;
    return Object.assign(radar, counts);
  }

  /**
   * Takes a frame: 'accepted', or 'repeated' where it was taken before. Throws where it is refused.
   *
   * @param {import('boresight').CalibrationFrame} frame
   * @param {{ aheadS: number }} limits
   */
  add(frame, limits) {
    this.#changed = true;
    const digest = digestOf(frame);
    if (this.#recent.has(frame.timeS, digest)) {
      this.repeated += 1;
      return 'repeated';
    }
    this.#checkTime(frame.timeS, limits);
    // A rejected frame counts in the estimate, too.
    this.#estimate = undefined;
    this.#calibration.addFrame(frame);
    this.timeS = frame.timeS;
    this.frames += 1;
    this.detections += frame.azimuthDeg.length;
    this.#recent.add(frame.timeS, digest);
    if (this.history.due(frame.timeS)) this.history.add(frame.timeS, this.estimate());
    return 'accepted';
  }

  /** @param {number} timeS @param {{ aheadS: number }} limits */
  #checkTime(timeS, { aheadS }) {
    const what = 'frame.timeS';
    if (!(Math.abs(timeS) <= LATEST_S)) {
      throw new Problem(422, 'out-of-range', { what, expected: `within ${LATEST_S} s of 0`, given: String(timeS) });
    }
    if (this.timeS === null) return;
    // Earlier times are for the calibration to judge: it rejects them, and starts a session where the clock was reset.
    if (timeS === this.timeS) {
      throw new Problem(422, 'time-backwards', { what, expected: `later than ${this.timeS} s`, given: `${timeS} s` });
    }
    // One wrong time far ahead would have all that follow refused.
    if (timeS > this.timeS + aheadS) {
      const expected = `within ${aheadS} s of ${this.timeS} s`;
      throw new Problem(422, 'time-ahead', { what, expected, given: `${timeS} s` });
    }
  }

  estimate() {
    this.#estimate ??= this.#calibration.estimate();
    return this.#estimate;
  }

  /** What is to be kept of it, where anything changed. @returns {[string, Uint8Array][]} */
  kept() {
    if (!this.#changed) return [];
    const { options, timeS, frames, detections, repeated, refused } = this;
    const head = { options, timeS, frames, detections, repeated, refused, recent: this.#recent.head };
    const state = pack(head, this.#calibration.snapshot(), ...this.#recent.parts);
    /** @type {[string, Uint8Array][]} */
    const changes = [[`radar/${this.name}`, state]];
    if (this.history.changed) changes.push([`history/${this.name}`, pack(this.history.head, this.history.bytes)]);
    return changes;
  }

  /** Says that what {@link kept} gave is kept, or is not. @param {boolean} settled */
  settle(settled) {
    this.#changed = !settled;
    this.history.changed = !settled;
  }

  /** What a fleet is told. */
  summary() {
    const { angleDeg, sigmaDeg, alignment, misaligned, frames, stale, clockResets, rejectedDetections } =
      this.estimate();
    return {
      radar: this.name,
      nominalDeg: this.options.nominalDeg ?? null,
      alarmDeg: this.options.alarmDeg ?? 1,
      timeS: this.timeS,
      // JSON has no infinity.
      angleDeg,
      sigmaDeg: Number.isFinite(sigmaDeg) ? sigmaDeg : null,
      alignment,
      misaligned,
      frames: this.frames,
      detections: this.detections,
      repeated: this.repeated,
      refused: { ...this.refused },
      verdicts: frames,
      stale,
      clockResets,
      rejectedDetections,
    };
  }

  /** All of it, with the whole estimate. */
  describe() {
    return { ...this.summary(), options: this.options, result: this.estimate(), history: this.history };
  }

  free() {
    this.#calibration[Symbol.dispose ?? Symbol.for('Symbol.dispose')]();
  }
}
