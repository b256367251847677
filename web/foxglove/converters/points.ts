/** Returns of a radar as a cloud of points, and as a scene of how fast they come and go. */
import type { PackedElementField, PointCloud, SceneUpdate, Time } from '@foxglove/schemas';
import type { Scan } from '../../messages/scan.ts';
import { color, entity, ORIGIN, poseAt } from './parts.ts';

/** Kinds of numbers and of lines, by their codes in Foxglove's schemas. */
const FLOAT32 = 7;
const LINE_LIST = 2;
/** Seconds along the ray that a line is long. */
const AHEAD_S = 1;
const CLOSING = color('#d55e00');
const RECEDING = color('#4aa8e8');
const RAD = Math.PI / 180;

/** Where detections are, in the radar's frame. */
export function places({ azimuthDeg, elevationDeg, rangeM }: Scan): { x: number; y: number; z: number }[] {
  return Array.from(azimuthDeg, (azimuth, i) => {
    const [range, elevation] = [rangeM[i] as number, (elevationDeg[i] as number) * RAD || 0];
    const ahead = range * Math.cos(elevation);
    return { x: ahead * Math.cos(azimuth * RAD), y: ahead * Math.sin(azimuth * RAD), z: range * Math.sin(elevation) };
  });
}

/** Points with what the radar says of each; names and units are those of `boresight serve`. */
export function pointCloud(scan: Scan, timestamp: Time): PointCloud {
  const at = places(scan);
  const { azimuthDeg, rangeM, rangeRateMps, rcsDbsm, amplitudeDb } = scan;
  const columns: [name: string, ArrayLike<number>][] = [
    ['x', at.map(({ x }) => x)],
    ['y', at.map(({ y }) => y)],
    ['z', at.map(({ z }) => z)],
    ['range_m', rangeM],
    ['azimuth_rad', azimuthDeg.map((azimuth) => azimuth * RAD)],
    ['range_rate_mps', rangeRateMps],
    ...(rcsDbsm ? [['rcs_dbsm', rcsDbsm] as [string, Float64Array]] : []),
    ...(amplitudeDb ? [['amplitude_db', amplitudeDb] as [string, Float64Array]] : []),
  ];
  const stride = 4 * columns.length;
  const data = new DataView(new ArrayBuffer(stride * azimuthDeg.length));
  columns.forEach(([, values], column) => {
    for (let i = 0; i < azimuthDeg.length; i++) data.setFloat32(i * stride + 4 * column, values[i] as number, true);
  });
  return {
    timestamp,
    frame_id: scan.frameId,
    pose: poseAt(ORIGIN),
    point_stride: stride,
    fields: columns.map(([name], i): PackedElementField => ({ name, offset: 4 * i, type: FLOAT32 })),
    data: new Uint8Array(data.buffer),
  };
}

/** A line along the ray of each detection, as long as its range changes in a second. */
export function rangeRates(scan: Scan, timestamp: Time): SceneUpdate {
  const lines = places(scan).flatMap((from, i) => {
    const [range, rate] = [scan.rangeM[i] as number, scan.rangeRateMps[i] as number];
    if (!(range > 0)) return [];
    // No farther than to the radar.
    const share = Math.max(1 + (rate * AHEAD_S) / range, 0);
    const to = { x: from.x * share, y: from.y * share, z: from.z * share };
    return [{ points: [from, to], color: rate < 0 ? CLOSING : RECEDING }];
  });
  return {
    deletions: [],
    entities: [
      entity({
        id: `range-rates ${scan.frameId}`,
        timestamp,
        frame_id: scan.frameId,
        lines: [
          {
            type: LINE_LIST,
            pose: poseAt(ORIGIN),
            thickness: 1.5,
            scale_invariant: true,
            points: lines.flatMap(({ points }) => points),
            color: RECEDING,
            colors: lines.flatMap(({ color }) => [color, color]),
            indices: [],
          },
        ],
      }),
    ],
  };
}
