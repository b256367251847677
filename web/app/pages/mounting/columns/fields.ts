/** Columns of the general tables (docs/formats.md), and what columns of other tables may hold of them. */

export interface Unit {
  name: string;
  /** From this unit to that of the general table. */
  factor: number;
  /** How names of columns say it. */
  words: RegExp;
}

export interface Field {
  /** Its column in the general table. */
  name: string;
  label: string;
  required: boolean;
  /** That of the general table first. */
  units: readonly Unit[];
  /** How names of columns say it. */
  words: RegExp;
  /** What positive values mean: in the general table, and the other way round. */
  signs?: readonly [string, string];
  /** Names count too, and are numbered. */
  names?: true;
  /** No column of the general table: azimuth and range follow from two such. */
  place?: true;
  examples: readonly [string, string];
}

export type GroupName = 'detections' | 'motion';

/** Dates as ISO 8601 has them are no factor of anything. */
export const DATE = 'date';

const unit = (name: string, factor: number, words: RegExp): Unit => ({ name, factor, words });
const TURN = Math.PI / 180;
const DEG = /\bdeg(rees?)?\b|°/;
const RAD = /\brad(ians?)?\b/;
const TIMES = [
  unit('s', 1, /\b(s|secs?|seconds?)\b/),
  unit('ms', 1e-3, /\bms(ec)?\b|\bmilli/),
  unit('us', 1e-6, /\bus(ec)?\b|µs|\bmicro/),
  unit('ns', 1e-9, /\bns(ec)?\b|\bnano/),
  unit(DATE, Number.NaN, /\b(date|datetime|iso|utc)\b/),
];
const SPEEDS = [
  unit('m/s', 1, /\bmps\b|\bm ?\/? ?s\b/),
  unit('km/h', 1 / 3.6, /\bkm ?\/? ?h\b|\bkmph\b|\bkph\b/),
  unit('mph', 0.44704, /\bmph\b/),
];
const LENGTHS = [unit('m', 1, /\bm\b/)];

const field = (
  name: string,
  label: string,
  units: readonly Unit[],
  words: RegExp,
  examples: readonly [string, string],
  more: Partial<Field> = {},
): Field => ({ name, label, required: false, units, words, examples, ...more });

const time = (examples: readonly [string, string]): Field =>
  field('time_s', 'Time', TIMES, /\b(time|timestamp|stamp|t|utc|date|datetime|epoch)\b/, examples, { required: true });

/** A field whose name says more stands before one whose name is part of it. */
export const FIELDS: Record<GroupName, readonly Field[]> = {
  detections: [
    time(['0.000', '0.000']),
    field(
      'azimuth_deg',
      'Azimuth',
      [unit('deg', 1, DEG), unit('rad', 1 / TURN, RAD)],
      /\b(azimuth|azi|az|bearing|phi|theta|angle)\b/,
      ['-12.5', '30.25'],
      { required: true, signs: ['left', 'right'] },
    ),
    field('x_m', 'x, along boresight', LENGTHS, /\b(x|dx|longitudinal)\b/, ['41.5', '14.9'], { place: true }),
    field('y_m', 'y, across', LENGTHS, /\b(y|dy|lateral)\b/, ['-9.2', '8.7'], {
      place: true,
      signs: ['left', 'right'],
    }),
    field(
      'range_rate_mps',
      'Range rate',
      SPEEDS,
      /\b(range ?rate|rate of range|doppler|vr|v r|v ?rel|vrad|radial|rdot|range (velocity|speed))\b/,
      ['-9.76', '-8.61'],
      { required: true, signs: ['receding', 'approaching'] },
    ),
    field('range_m', 'Range', LENGTHS, /\b(range|dist|distance|radius|r)\b/, ['42.5', '17.3']),
    field('rcs_dbsm', 'Cross-section', [unit('dBsm', 1, /\bdbsm\b/)], /\b(rcs|cross ?section)\b/, ['3.5', '-2']),
    field('sensor', 'Sensor', [], /\b(sensor|radar|device)\b/, ['1', '1'], { names: true }),
  ],
  motion: [
    time(['0.000', '0.050']),
    field(
      'yaw_rate_degps',
      'Yaw rate',
      [unit('deg/s', 1, /\bdeg(rees?)?\b|\bdegps\b|\bdps\b|°/), unit('rad/s', 1 / TURN, /\brad(ians?)?\b|\bradps\b/)],
      /\b(yaw ?rate|turn ?rate|heading rate|gyro ?z|omega ?z|wz)\b/,
      ['1.25', '1.5'],
      { required: true, signs: ['turning left', 'turning right'] },
    ),
    field('speed_mps', 'Speed', SPEEDS, /\b(speed|velocity|v ?ego|vx|v x)\b/, ['10', '10.1'], {
      signs: ['forward', 'backward'],
    }),
    field('x_m', 'Position x', LENGTHS, /\b(x|east|easting)\b/, ['0', '0.5']),
    field('y_m', 'Position y', LENGTHS, /\b(y|north|northing)\b/, ['0', '0.01']),
    field(
      'yaw_rad',
      'Heading',
      [unit('rad', 1, RAD), unit('deg', TURN, DEG)],
      /\b(yaw|heading)\b(?! ?rate)/,
      ['0', '0.01'],
      { signs: ['turned left', 'turned right'] },
    ),
  ],
};

/** Of detections, in place of azimuth and range. */
export const PLACE = ['x_m', 'y_m'];

/** Given all together or not at all. */
export const POSE = ['x_m', 'y_m', 'yaw_rad'];
