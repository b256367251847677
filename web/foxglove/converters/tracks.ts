/** Tracks of a radar, radar_msgs/RadarTracks, as boxes with arrows of their velocity. */
import type { PackedElementField, PointCloud, SceneEntity, SceneUpdate, Time } from '@foxglove/schemas';
import { MessageProblem } from '../../messages/problem.ts';
import { stampOf } from '../../messages/scan.ts';
import { type Fields, isFields, listOf, numberOf, part } from '../../messages/values.ts';
import { color, entity, ORIGIN, poseAlong, poseAt } from './parts.ts';

/** Most tracks of a message. */
const MOST_TRACKS = 4096;
/** What of a track without a size is drawn, m. */
const LEAST_M = 0.5;
/** Velocities below are not drawn, m/s. */
const STANDING_MPS = 0.1;
const FLOAT32 = 7;

/** Colours by `classification`, those of radar_msgs/RadarTrack. */
const STATIC = 1;
const DYNAMIC = 2;
const COLORS = new Map([
  [STATIC, color('#98a3ad', 0.5)],
  [DYNAMIC, color('#d55e00', 0.5)],
]);
const UNKNOWN = color('#4aa8e8', 0.5);
const VELOCITY = color('#e8b93c');

interface Track {
  id: string;
  position: Vector;
  velocity: Vector;
  size: Vector;
  classification: number;
}

interface Vector {
  x: number;
  y: number;
  z: number;
}

/** A track as a box that lies along its velocity, and an arrow as long as it moves in a second. */
export function tracksScene(message: unknown, timestamp: Time): SceneUpdate {
  const { tracks, frameId } = tracksOf(message);
  // What is no longer tracked goes: entities of a topic that are not told of again.
  return {
    deletions: [{ timestamp, type: 1, id: '' }],
    entities: tracks.map((track): SceneEntity => {
      const { position, velocity, size, id } = track;
      const speed = Math.hypot(velocity.x, velocity.y, velocity.z);
      const pose = speed > STANDING_MPS ? poseAt(position, Math.atan2(velocity.y, velocity.x)) : poseAt(position);
      const paint = COLORS.get(track.classification) ?? UNKNOWN;
      return entity({
        id: `track ${id}`,
        timestamp,
        frame_id: frameId,
        cubes: [{ pose, size: sized(size), color: paint }],
        arrows:
          speed > STANDING_MPS
            ? [
                {
                  pose: poseAlong(position, velocity),
                  shaft_length: 0.8 * speed,
                  shaft_diameter: 0.15,
                  head_length: 0.2 * speed,
                  head_diameter: 0.4,
                  color: VELOCITY,
                },
              ]
            : [],
        texts: [
          {
            pose: poseAt({ ...position, z: position.z + sized(size).z / 2 + 0.5 }),
            billboard: true,
            font_size: 12,
            scale_invariant: true,
            color: { ...paint, a: 1 },
            text: `${speed.toFixed(1)} m/s`,
          },
        ],
      });
    }),
  };
}

/** Tracks as points. */
export function tracksCloud(message: unknown, timestamp: Time): PointCloud {
  const { tracks, frameId } = tracksOf(message);
  const names = ['x', 'y', 'z', 'vx_mps', 'vy_mps', 'classification'] as const;
  const rows = tracks.map(({ position: { x, y, z }, velocity, classification }) => [
    x,
    y,
    z,
    velocity.x,
    velocity.y,
    classification,
  ]);
  return {
    timestamp,
    frame_id: frameId,
    pose: poseAt(ORIGIN),
    point_stride: 4 * names.length,
    fields: names.map((name, i): PackedElementField => ({ name, offset: 4 * i, type: FLOAT32 })),
    data: new Uint8Array(Float32Array.from(rows.flat()).buffer),
  };
}

function tracksOf(message: unknown): { tracks: Track[]; frameId: string } {
  if (!isFields(message)) throw new MessageProblem('malformed', 'no tracks');
  const given = listOf(message, 'tracks');
  if (given.length > MOST_TRACKS)
    throw new MessageProblem('too-large', `${given.length} tracks; at most ${MOST_TRACKS} are expected`);
  const tracks = Array.from(given).flatMap((track): Track[] => {
    if (!isFields(track)) return [];
    const read = {
      id: idOf(track),
      position: vector(track, 'position'),
      velocity: vector(track, 'velocity'),
      size: vector(track, 'size'),
      classification: numberOf(track, 'classification'),
    };
    return Number.isFinite(read.position.x + read.position.y) ? [read] : [];
  });
  return { tracks, frameId: stampOf(message).frameId };
}

function vector(track: Fields, name: string): Vector {
  const of = part(track, name);
  const read = (axis: string): number => numberOf(of, axis) || 0;
  return { x: numberOf(of, 'x'), y: numberOf(of, 'y'), z: read('z') };
}

/** The UUID in hexadecimal digits. */
function idOf(track: Fields): string {
  const uuid = isFields(track.uuid) ? track.uuid.uuid : undefined;
  if (!Array.isArray(uuid) && !ArrayBuffer.isView(uuid)) return String(track.uuid ?? '');
  return Array.from(uuid as ArrayLike<number>, (byte) => byte.toString(16).padStart(2, '0')).join('');
}

const sized = ({ x, y, z }: Vector): Vector => ({
  x: Math.max(x || 0, LEAST_M),
  y: Math.max(y || 0, LEAST_M),
  z: Math.max(z || 0, LEAST_M),
});
