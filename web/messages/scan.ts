/** Scans of a radar in messages of several kinds. */
import { type Columns, foxgloveCloud, MOST_POINTS, pointCloud2 } from './packed.ts';
import { MessageProblem } from './problem.ts';
import { schemaOf } from './schemas.ts';
import { type Fields, isFields, listOf, numberOf, secondsOf } from './values.ts';

/** Detections of a scan as columns of one length, in the radar's frame. */
export interface Scan {
  /** NaN where the message has none. */
  timeS: number;
  frameId: string;
  /** Positive to the left. */
  azimuthDeg: Float64Array;
  elevationDeg: Float64Array;
  /** Positive when receding. */
  rangeRateMps: Float64Array;
  rangeM: Float64Array;
  /** Radar cross-sections, where the message has them. */
  rcsDbsm: Float64Array | null;
  /** What the message says of strength, dB, where it says so. */
  amplitudeDb: Float64Array | null;
  /** Detections that were left out, as their azimuth or range rate is no finite number. */
  incomplete: number;
}

/** Drivers disagree: -1 for azimuths that are positive to the right, or range rates that are positive when closing. */
export interface Signs {
  azimuth: 1 | -1;
  rangeRate: 1 | -1;
}

export const USUAL_SIGNS: Signs = { azimuth: 1, rangeRate: 1 };

const DEG = 180 / Math.PI;
const RANGE_RATE = [
  'range_rate',
  'range_rate_mps',
  'radial_velocity',
  'radial_speed',
  'doppler_velocity',
  'doppler',
  'velocity',
  'v_r',
  'vr',
];

type Raw = Omit<Scan, 'timeS' | 'frameId' | 'incomplete' | 'azimuthDeg' | 'elevationDeg'> & {
  azimuthRad: Float64Array;
  elevationRad: Float64Array;
};

const KINDS: Readonly<Record<string, (message: Fields) => Raw>> = {
  'radar_msgs/RadarScan': radarScan,
  'sensor_msgs/PointCloud2': (message) => cloud(pointCloud2(message)),
  'foxglove.PointCloud': (message) => cloud(foxgloveCloud(message)),
};

/** The schemas that scans come in. */
export const SCAN_SCHEMAS = Object.keys(KINDS);

export const hasScans = (schemaName: string): boolean => Object.hasOwn(KINDS, schemaOf(schemaName));

/** The scan in a message. Throws a `MessageProblem` where there is none. */
export function scanOf(schemaName: string, message: unknown, signs: Signs = USUAL_SIGNS): Scan {
  const read = KINDS[schemaOf(schemaName)];
  if (!read || !isFields(message)) throw new MessageProblem('malformed', `${schemaName} has no scans`);
  const { azimuthRad, elevationRad, rangeRateMps, rangeM, rcsDbsm, amplitudeDb } = read(message);
  const kept = Array.from(azimuthRad.keys()).filter(
    (i) => Number.isFinite(azimuthRad[i]) && Number.isFinite(rangeRateMps[i]),
  );
  const taken = (column: Float64Array, factor = 1): Float64Array =>
    Float64Array.from(kept, (i) => factor * (column[i] as number));
  return {
    ...stampOf(message),
    azimuthDeg: taken(azimuthRad, DEG * signs.azimuth),
    elevationDeg: taken(elevationRad, DEG),
    rangeRateMps: taken(rangeRateMps, signs.rangeRate),
    rangeM: taken(rangeM),
    rcsDbsm: rcsDbsm && taken(rcsDbsm),
    amplitudeDb: amplitudeDb && taken(amplitudeDb),
    incomplete: azimuthRad.length - kept.length,
  };
}

/** Time and frame of a message, with a header as ROS has it or as Foxglove's schemas have them. */
export function stampOf(message: Fields): { timeS: number; frameId: string } {
  const header = isFields(message.header) ? message.header : message;
  return {
    timeS: secondsOf(header.stamp ?? header.timestamp),
    frameId: typeof header.frame_id === 'string' ? header.frame_id : '',
  };
}

function radarScan(message: Fields): Raw {
  const returns = listOf(message, 'returns');
  if (returns.length > MOST_POINTS)
    throw new MessageProblem('too-large', `${returns.length} returns; at most ${MOST_POINTS} are expected`);
  const column = (name: string): Float64Array =>
    Float64Array.from(returns, (one) => (isFields(one) ? numberOf(one, name) : Number.NaN));
  return {
    azimuthRad: column('azimuth'),
    elevationRad: column('elevation'),
    rangeRateMps: column('doppler_velocity'),
    rangeM: column('range'),
    rcsDbsm: null,
    amplitudeDb: column('amplitude'),
  };
}

/** Points in the radar's frame: by range and angles where the cloud has them, by their places otherwise. */
function cloud({ count, column }: Columns): Raw {
  const none = (): Float64Array => new Float64Array(count);
  const [x, y] = [column('x'), column('y')];
  const z = column('z') ?? none();
  const polar = column('azimuth', 'azimuth_rad', 'azimuth_angle');
  if (!polar && !(x && y)) throw new MessageProblem('no-field', 'neither azimuth nor x and y are in the cloud');
  const [px, py] = [x ?? none(), y ?? none()];
  const made = (of: (i: number) => number): Float64Array => Float64Array.from({ length: count }, (_, i) => of(i));
  const at = (values: Float64Array, i: number): number => values[i] as number;
  const rangeM = column('range', 'range_m') ?? made((i) => Math.hypot(at(px, i), at(py, i), at(z, i)));
  const azimuthRad = polar ?? made((i) => Math.atan2(at(py, i), at(px, i)));
  const elevationRad =
    column('elevation', 'elevation_rad', 'elevation_angle') ??
    made((i) => (rangeM[i] ? Math.asin(Math.min(Math.max(at(z, i) / at(rangeM, i), -1), 1)) : 0));
  return {
    azimuthRad,
    elevationRad,
    rangeRateMps: rateOf({ count, column }, azimuthRad),
    rangeM,
    rcsDbsm: column('rcs', 'rcs_dbsm', 'RCS') ?? null,
    amplitudeDb: column('amplitude', 'snr', 'snr_db') ?? null,
  };
}

/** Range rates, or velocities along the ray. */
function rateOf({ column, count }: Columns, azimuthRad: Float64Array): Float64Array {
  const rate = column(...RANGE_RATE);
  if (rate) return rate;
  const [vx, vy] = [column('vx'), column('vy')];
  if (!vx || !vy)
    throw new MessageProblem(
      'no-field',
      `a range rate is expected in the cloud (${RANGE_RATE.join(', ')}, or vx and vy)`,
    );
  return Float64Array.from({ length: count }, (_, i) => {
    const azimuth = azimuthRad[i] as number;
    return (vx[i] as number) * Math.cos(azimuth) + (vy[i] as number) * Math.sin(azimuth);
  });
}
