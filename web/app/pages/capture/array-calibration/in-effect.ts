/** Which calibration of the array is in effect, and calibrations out of files. */
import { computed, signal } from '@preact/signals';
import type { ArrayCalibration, ArrayInput, SteeringTable } from 'boresight';
import { api, describeError, FileProblem, type Problem, pool } from '../../../data.ts';
import { ARRAY_CALIBRATIONS } from '../../../kinds.ts';
import { announce } from '../../../state/announce.ts';
import { type Loaded, loaded } from '../files/files.ts';
import { captureState, update } from '../state.ts';
import { calibrationName, idOf, keep, type OwnCalibration, ownCalibrations, ownOf } from './own-calibrations.ts';

/** Why a file is no calibration, or not of this array. */
export const calibrationProblem = signal<Problem | null>(null);

/** Whether a link names a calibration that only its maker has. */
export const calibrationWanted = computed(() => {
  const { calibration } = captureState.value;
  return idOf(calibration) !== null && !ownOf(calibration);
});

/** The array that is chosen by hand. */
export const chosenArray = (): { array?: ArrayInput } => {
  const { array } = captureState.value;
  return array === 'auto' ? {} : { array };
};

/** What the open capture's configuration brings. */
export const configured = computed<ArrayCalibration | null>(() => {
  const capture = loaded.value;
  const { array } = chosenArray();
  if (!capture) return null;
  try {
    return api.configuredCalibration(capture.cfg, array);
  } catch {
    // What is wrong with the configuration is said where it is opened.
    return null;
  }
});

/** What captures are processed by; null for nothing. */
export const inEffect = computed<ArrayCalibration | null>(() => {
  const { calibration } = captureState.value;
  if (calibration === 'none') return null;
  return ownOf(calibration)?.value ?? configured.value;
});

/** Lets a calibration take effect. */
export function apply({ id, name }: OwnCalibration): void {
  calibrationProblem.value = null;
  update({ calibration: `own:${id}` });
  announce(`The array is calibrated by ${name}.`);
}

/** What cannot be used changes nothing. */
export async function openCalibrations(files: readonly File[]): Promise<void> {
  for (const file of files) {
    try {
      apply(await keep(await calibrationOf(file), calibrationName(file.name)));
    } catch (error) {
      calibrationProblem.value = describeError(error);
      return;
    }
  }
}

/** Puts one's own calibrations away. */
export function closeCalibrations(): void {
  ownCalibrations.value = [];
  calibrationProblem.value = null;
}

/** More than a table of measured steering vectors takes. */
const LARGEST_BYTES = 64 * 2 ** 20;
const LINE = /^\s*compRangeBiasAndRxChanPhase\b.*$/m;

const isConfiguration = (name: string): boolean => /\.(cfg|txt)$/i.test(name);

/** Whether a file is a calibration, by what is in it: other JSON is of mmWave Studio, other .cfg of a radar. */
export async function isCalibration(file: File): Promise<boolean> {
  if (file.size > LARGEST_BYTES || /\.(mmwave|setup)\.json$/i.test(file.name)) return false;
  if (ARRAY_CALIBRATIONS.test(file.name)) return true;
  if (/\.json$/i.test(file.name)) return /"(channels|responses)"/.test(await file.text());
  if (!isConfiguration(file.name)) return false;
  const text = await file.text();
  return LINE.test(text) && !/^\s*profileCfg\b/m.test(text);
}

async function calibrationOf(file: File): Promise<ArrayCalibration> {
  const refused = (code: string, message: string): FileProblem => new FileProblem(code, file.name, message);
  if (file.size > LARGEST_BYTES) {
    const [given, most] = [file.size, LARGEST_BYTES].map((bytes) => `${Math.round(bytes / 2 ** 20)} MiB`);
    throw refused('too-large', `${given}; at most ${most} are expected`);
  }
  const text = await file.text();
  const capture = loaded.peek();
  try {
    const made = isConfiguration(file.name) ? ofLine(text, file.name, capture) : await ofJson(text, file.name, capture);
    // On one cell, which refuses what is wrong with it.
    await capture?.kept.cellSnapshots(
      { rangeBin: 0, dopplerBin: 0, frame: 0 },
      { ...chosenArray(), calibration: made },
    );
    return made;
  } catch (error) {
    if (error instanceof FileProblem) throw error;
    const { code, message } = describeError(error);
    throw refused(code, message + mending(code));
  }
}

/** What of the page helps. */
export function mending(code: string): string {
  switch (code) {
    case 'other-array':
      return '. It is of another array: choose the one it was made for under Detection, Virtual array, or another under Array calibration';
    case 'no-calibration-cells':
      return '. Lower “Least SNR” or raise “Most left over”, take more frames, or add a reflector that you know';
    case 'not-determined':
      return '. Choose gain and phase under “Estimate”, or add reflectors at other angles';
    case 'missing':
      return '. Choose the board under Detection, Virtual array';
    default:
      return '';
  }
}

const NEEDS_CAPTURE = 'the capture it is for has to be open: its configuration says which channels there are';

/** TI’s line, in the configuration of the capture in place of what stands there. */
function ofLine(text: string, name: string, capture: Loaded | null): ArrayCalibration {
  const line = LINE.exec(text)?.[0];
  if (line === undefined) throw new FileProblem('no-calibration', name, 'it has no line compRangeBiasAndRxChanPhase');
  if (!capture) throw new FileProblem('no-capture', name, NEEDS_CAPTURE);
  const others = capture.cfg.split('\n').filter((one) => !LINE.test(one));
  const made = api.configuredCalibration([...others, line, ''].join('\n'), chosenArray().array);
  if (made) return made;
  const { receivers, transmitters } = capture.info.config;
  throw new FileProblem(
    'no-calibration',
    name,
    `its line compRangeBiasAndRxChanPhase changes nothing, cannot be read, or has other channels than the ${transmitters} transmitters and ${receivers} receivers of the capture`,
  );
}

async function ofJson(text: string, name: string, capture: Loaded | null): Promise<ArrayCalibration> {
  let value: unknown;
  try {
    value = JSON.parse(text);
  } catch {
    const expected = 'a calibration as “Save JSON” writes it is expected';
    throw new FileProblem('no-calibration', name, `it is no JSON, or is cut off; ${expected}`);
  }
  // Results have their calibration in them.
  const record = has(value, 'calibration') ? value.calibration : value;
  if (has(record, 'responses')) {
    const array = capture && (chosenArray().array ?? capture.info.config.array);
    if (!array) throw new FileProblem('no-capture', name, NEEDS_CAPTURE);
    const { calibration } = await pool().calibrateBySteeringTable(record as unknown as SteeringTable, array);
    return calibration;
  }
  if (['tx', 'rx', 'channels'].every((key) => has(record, key))) return record as ArrayCalibration;
  throw new FileProblem(
    'no-calibration',
    name,
    'it is other JSON; a calibration with tx, rx and channels is expected, or a table with azimuthDeg and responses',
  );
}

const has = <K extends string>(of: unknown, key: K): of is Record<K, unknown> =>
  typeof of === 'object' && of !== null && Object.hasOwn(of, key);
