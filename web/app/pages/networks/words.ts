/** What cards mean, in the words of radar. */

import { byteSize, count, fixed } from '../../../plots/format.ts';
import { arrayOf, type Card, elementsOf, targetsOf, trainedOnBoards } from '../../networks/models.ts';

/** What the network is for, in one sentence. */
export function taskOf(card: Card): string {
  const targets = targetsOf(card);
  switch (card.network) {
    case 'aaetr':
    case 'learned-pursuit':
      return `Finds the angles and amplitudes of ${most(card)} targets in one snapshot`;
    case 'unrolled-iaa':
      return `Gives the spectrum of ${most(card)} targets in one snapshot`;
    case 'covariance-cnn':
      return `Finds the angles of ${most(card)} uncorrelated sources in the covariance of many snapshots`;
    case 'deep-music':
      return `Gives MUSIC’s spectrum of ${most(card)} uncorrelated sources from the covariance of many snapshots`;
    case 'counting':
      return 'Tells whether a region of interest holds no, one or two targets';
    default:
      return `Tells in which whole degrees from −10 to 10 the ${targets === 1 ? 'target' : `${targets ?? ''} targets`} of a region of interest ${targets === 1 ? 'lies' : 'lie'}`;
  }
}

/** The same and its input in a few words, for a table. */
export function briefly(card: Card): [task: string, input: string] {
  const targets = targetsOf(card);
  const elements = elementsOf(card);
  switch (card.network) {
    case 'aaetr':
    case 'learned-pursuit':
      return [
        `Angles and amplitudes of ${most(card)} targets`,
        `1 snapshot, ${elements === null ? arrayOf(card) : `${elements} elements`}`,
      ];
    case 'unrolled-iaa':
      return [`Spectrum of ${most(card)} targets`, `1 snapshot, ${elements} elements`];
    case 'covariance-cnn':
      return [`Angles of ${most(card)} sources`, `covariance, ${elements} elements`];
    case 'deep-music':
      return [`MUSIC’s spectrum of ${most(card)} sources`, `covariance, ${elements} elements`];
    case 'counting':
      return ['Number of targets: 0, 1 or 2', `covariance, ${elements} elements`];
    case 'dnn':
      return [
        `Whole degrees of ${targets ?? 'the'} ${targets === 1 ? 'target' : 'targets'}`,
        `covariance, ${elements} elements`,
      ];
    default:
      return [
        `Whole degrees of ${targets ?? 'the'} ${targets === 1 ? 'target' : 'targets'}`,
        `${card.inputs[0]?.axes.slice(1, 4).join(' × ')} bins, elements, chirps`,
      ];
  }
}

function most({ data }: Card): string {
  const targets = data?.targets;
  return Array.isArray(targets) ? `up to ${targets[1]}` : 'several';
}

type Range = readonly [number, number];
const isRange = (value: unknown): value is Range =>
  Array.isArray(value) && value.length === 2 && value.every((part) => typeof part === 'number');
const range = (value: unknown, unit: string): string | null =>
  isRange(value)
    ? value[0] === value[1]
      ? `${minus(value[0])} ${unit}`
      : `${minus(value[0])} to ${minus(value[1])} ${unit}`
    : null;
const minus = (value: number): string => String(value).replace('-', '−');

/** The data it was trained on: quantity and value. */
export function trainedOn(card: Card): [string, string][] {
  const { data = {} } = card;
  const rows: [string, string | null][] = [
    ['Array', arrayOf(card)],
    ['Waveform', typeof data.waveform === 'string' ? data.waveform : null],
    [
      'Targets',
      isRange(data.targets)
        ? data.targets[0] === data.targets[1]
          ? String(data.targets[0])
          : `${data.targets[0]} to ${data.targets[1]}`
        : null,
    ],
    ['Field of view', typeof data.fieldOfViewDeg === 'number' ? `±${data.fieldOfViewDeg}°` : null],
    ['Snapshots', range(data.snapshots, 'in a covariance')],
    ['Powers', range(data.db, 'dB')],
    ['SNR', range(data.snrDb, 'dB')],
    [
      'SNR in the second stage from',
      typeof data.secondStageLowestSnrDb === 'number' ? `${minus(data.secondStageLowestSnrDb)} dB` : null,
    ],
    ['Range', range(data.rangeM, 'm')],
    ['Errors of elements', trainedOnBoards(card) ? `${data.channelDb} dB and ${data.channelDeg}° (deviations)` : null],
    [
      'Errors of position',
      typeof data.positionError === 'number'
        ? data.positionError
          ? `${data.positionError} half wavelengths`
          : 'none'
        : null,
    ],
  ];
  return rows.filter((row): row is [string, string] => row[1] !== null);
}

/** How it was made, beside its runs of training. */
export function made(card: Card): [string, string][] {
  const rows: [string, string | null][] = [
    ['Samples seen', card.samplesSeen === undefined ? null : count(card.samplesSeen)],
    ['Time', card.hours === undefined ? null : hoursText(card.hours)],
    ['Software', card.software ?? null],
    ['Weights stored as', card.onnx?.weights ?? null],
    [
      'Export differs from PyTorch by',
      card.onnx?.parity === undefined
        ? null
        : card.onnx.parity
            .toExponential(1)
            .replace('e-', ' × 10⁻')
            .replace(/\d$/, (digit) => '⁰¹²³⁴⁵⁶⁷⁸⁹'[Number(digit)] ?? digit),
    ],
  ];
  return rows.filter((row): row is [string, string] => row[1] !== null);
}

export const hoursText = (hours: number): string => `${fixed(hours, hours < 10 ? 2 : 1)} h`;

export const sizeOf = ({ bytes }: Card): string => (bytes === undefined ? '–' : byteSize(bytes));

/** A metric of cards: heading with its unit, what it means, digits. */
export interface Metric {
  title: string;
  help: string;
  digits: number;
  percent?: boolean;
}

export const METRICS: Record<string, Metric> = {
  array: {
    title: 'Array',
    help: 'The array that the snapshots are of',
    digits: 0,
  },
  targets: { title: 'Targets', help: 'Targets in a snapshot', digits: 0 },
  snrDb: {
    title: 'SNR (dB)',
    help: 'Of a 0 dB target at one element; of one sample of one chirp where the network sees regions',
    digits: 0,
  },
  f1: {
    title: 'F1',
    help: 'Largest harmonic mean of precision and recall over thresholds; right is what lies within 0.5° of a target',
    digits: 4,
  },
  strictF1: { title: 'F1, one to one', help: 'The same where two predictions of one target count once', digits: 4 },
  precision: { title: 'Precision', help: 'Share of the predictions that are right', digits: 4 },
  recall: { title: 'Recall', help: 'Share of the targets that are found', digits: 4 },
  angleErrorDeg: { title: 'Angle error (°)', help: 'Mean absolute error of right predictions', digits: 3 },
  magnitudeErrorDb: { title: 'Power error (dB)', help: 'Mean absolute error of right predictions', digits: 2 },
  accuracy: {
    title: 'Counted rightly',
    help: 'Share of the regions whose number of targets is told rightly',
    digits: 1,
    percent: true,
  },
  accuracyOfNone: {
    title: 'Of none',
    help: 'Share of the regions without a target that are counted so',
    digits: 1,
    percent: true,
  },
  accuracyOfOne: {
    title: 'Of one',
    help: 'Share of the regions with one target that are counted so',
    digits: 1,
    percent: true,
  },
  accuracyOfTwo: {
    title: 'Of two',
    help: 'Share of the regions with two targets that are counted so',
    digits: 1,
    percent: true,
  },
  within0Deg: {
    title: 'Exact',
    help: 'Share of the regions in which all whole degrees are right',
    digits: 1,
    percent: true,
  },
  within1Deg: {
    title: 'Within 1°',
    help: 'Share of the regions in which all directions are within 1°',
    digits: 1,
    percent: true,
  },
  within2Deg: {
    title: 'Within 2°',
    help: 'Share of the scenes in which all directions are within 2°',
    digits: 1,
    percent: true,
  },
  within4Deg: {
    title: 'Within 4°',
    help: 'Share of the regions in which all directions are within 4°',
    digits: 1,
    percent: true,
  },
  closePairsWithin1Deg: {
    title: 'Close pairs within 1°',
    help: 'The same of pairs closer than 4°',
    digits: 1,
    percent: true,
  },
  rmseDeg: { title: 'RMSE (°)', help: 'Root mean square error', digits: 3 },
};

export function metricText(key: string, value: number | string | undefined): string {
  if (value === undefined) return '–';
  if (typeof value === 'string') return value;
  const { digits = 3, percent = false } = METRICS[key] ?? {};
  return percent ? `${fixed(100 * value, digits)}\u00a0%` : fixed(value, digits);
}
