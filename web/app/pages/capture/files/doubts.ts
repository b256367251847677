/** Signs that a capture is not what it is taken for. */
import { count, fixed, percentage } from '../../../../plots/format.ts';
import type { Shown } from '../detections/process.ts';
import { captureState } from '../state.ts';
import type { Loaded } from './files.ts';
import { otherLoopLength } from './loop-length.ts';

export interface Doubt {
  code: string;
  message: string;
}

/** Remarks of the package that say the .bin and the .cfg do not belong to each other. */
const OF_SIZE = ['trailing-bytes', 'frame-count'];

/** Remarks of the package that say how samples are read wrong, with what mends it. */
const OF_READING: Readonly<Record<string, string>> = {
  'iq-swapped': 'Files, Order of I and Q has “as the samples tell”.',
  'other-lanes': 'Files, Lanes of the board has the other.',
  'cascade-index': 'Open the files of one recording together.',
  'cascade-out-of-step': 'Angles of these frames are wrong; record again.',
};

/** How files begin that are something else. */
const BEGINNINGS: readonly [bytes: string, what: string][] = [
  ['\x89PNG', 'a PNG picture'],
  ['\xff\xd8\xff', 'a JPEG picture'],
  ['GIF8', 'a GIF picture'],
  ['RIFF', 'a sound or film (RIFF)'],
  ['%PDF', 'a PDF document'],
  ['PK\x03\x04', 'a ZIP archive'],
  ['\x1f\x8b', 'a gzip archive'],
  ['\x89HDF', 'an HDF5 file'],
];

/** Samples looked at for their signs. */
const LOOKED_AT = 65_536;
/** An echo is as often below zero as above; a strong leakage at the converter moves that by some percent. */
const LEAST_SHARE_BELOW = 0.1;
/** Of all samples; a receiver that is driven into its limits makes targets that are not there. */
const MOST_CLIPPED = 1e-3;
/** What noise does not reach, dB over the noise of the cells around. */
const NOISE_SNR_DB = 15;

export function doubtsOf({ capture, frame, view }: Shown): Doubt[] {
  const doubts: Doubt[] = [];
  const { bin, info } = capture;
  const doubt = (code: string, message: string): void => {
    doubts.push({ code, message });
  };
  const begins = String.fromCharCode(...bin.subarray(0, 4));
  const kind = BEGINNINGS.find(([bytes]) => begins.startsWith(bytes));
  if (kind) doubt('other-file', `The .bin begins as ${kind[1]} does. Open the raw samples that the board recorded.`);
  if (capture.missingParts.length > 0) {
    doubt(
      'missing-part',
      `Of this recording ${capture.missingParts.join(', ')} ${capture.missingParts.length > 1 ? 'are' : 'is'} missing. What follows is read as if nothing lay between, so times are wrong from there on, and frames as well where the file before does not end with a whole one. Open all files of the recording together.`,
    );
  }
  const below = shareBelowZero(bin);
  if (below < LEAST_SHARE_BELOW || below > 1 - LEAST_SHARE_BELOW) {
    doubt(
      'one-sided',
      `${percentage(below)} of the samples are below zero, where echoes are as often below as above. The .bin may be something else than raw samples.`,
    );
  }
  // What repeats is looked for in complex samples as two lanes lay them down.
  const known = info.config.layout === 'two-lane' && info.config.waveform.sampling === 'complex';
  if (known && doubts.every(({ code }) => code === 'missing-part')) {
    const other = knownLoopLength(capture);
    const { transmitters, samples } = info.config.waveform;
    if (other !== null) {
      doubt(
        'loop-length',
        `The samples repeat every ${count(other)}, as a loop of chirps does; by the .cfg a loop has ${count(samples * info.config.receivers * transmitters)} (${samples} samples, ${info.config.receivers} receivers, ${transmitters} transmitters). It may be that of another recording. Open the .cfg that this .bin was recorded with.`,
      );
    }
  }
  for (const { code, message } of info.warnings) {
    if (OF_SIZE.includes(code)) doubt(code, `${sentence(message)} Open the .cfg that this .bin was recorded with.`);
  }
  for (const { code, message } of [...info.warnings, ...(capture.cascade ?? [])]) {
    const mends = OF_READING[code];
    if (mends) doubt(code, `${sentence(message)} ${mends}`);
  }
  const { waveform, receivers } = info.config;
  const frames = frame === 'all' ? view.frames : 1;
  const samples = frames * waveform.loops * waveform.transmitters * receivers * waveform.samples;
  const clipped = view.counts.clippedSamples / samples;
  if (clipped > MOST_CLIPPED) {
    doubt(
      'clipped',
      `${percentage(clipped)} of the samples are at the converter’s limits, which makes targets that are not there. Record with less receiver gain (profileCfg).`,
    );
  }
  const falseAlarm = Number(captureState.value.falseAlarm);
  const expected = falseAlarm * view.rangeDopplerDb.length;
  const over = view.counts.cellsOverThreshold;
  const strongest = Math.max(...view.detections.map(({ snrDb }) => snrDb), Number.NEGATIVE_INFINITY);
  if (over <= expected + 4 * Math.sqrt(expected) + 2 && strongest < NOISE_SNR_DB) {
    doubt(
      'like-noise',
      `This looks like noise: ${over === 0 ? 'no cell stands' : `${count(over)} cells stand`} out, and noise alone gives ${expected < 0.1 ? 'hardly any' : fixed(expected, 1)}. Where targets were in view, the .cfg is that of another capture, or the .bin holds no raw samples; where they are weak, Detection has a higher false-alarm rate.`,
    );
  }
  return doubts;
}

const loopLengths = new WeakMap<Loaded, number | null>();

/** Looked for once a capture. */
function knownLoopLength(capture: Loaded): number | null {
  const { waveform, receivers } = capture.info.config;
  const chirp = waveform.samples;
  const known = loopLengths.get(capture);
  if (known !== undefined) return known;
  const made = otherLoopLength(capture.bin, { loop: chirp * receivers * waveform.transmitters, chirp });
  loopLengths.set(capture, made);
  return made;
}

/** Of 16-bit samples spread over the file. */
function shareBelowZero(bin: Uint8Array): number {
  const view = new DataView(bin.buffer, bin.byteOffset, bin.byteLength);
  const all = Math.floor(bin.byteLength / 2);
  // An odd step looks at I and Q alike.
  const step = Math.max(Math.floor(all / LOOKED_AT), 1) | 1;
  let [below, looked] = [0, 0];
  for (let i = 0; i < all; i += step) {
    below += Number(view.getInt16(2 * i, true) < 0);
    looked += 1;
  }
  return below / Math.max(looked, 1);
}

const sentence = (text: string): string => `${text.charAt(0).toUpperCase()}${text.slice(1)}.`;
