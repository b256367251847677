/** Parts of Foxglove's messages. */
import type { Color, Point3, Pose, SceneEntity } from '@foxglove/schemas';

export const ORIGIN: Point3 = { x: 0, y: 0, z: 0 };

/** A pose that is turned about the vertical, and after that tilted upwards. */
export function poseAt(position: Point3, yawRad = 0, pitchRad = 0): Pose {
  const [cy, sy] = [Math.cos(yawRad / 2), Math.sin(yawRad / 2)];
  // A positive turn about y, which is to the left, points down.
  const [cp, sp] = [Math.cos(-pitchRad / 2), Math.sin(-pitchRad / 2)];
  return { position, orientation: { x: -sy * sp, y: cy * sp, z: sy * cp, w: cy * cp } };
}

/** A pose of which x is along a vector. */
export const poseAlong = (position: Point3, { x, y, z }: Point3): Pose =>
  poseAt(position, Math.atan2(y, x), Math.atan2(z, Math.hypot(x, y)));

export const color = (hex: string, a = 1): Color => {
  const [r = 0, g = 0, b = 0] = [1, 3, 5].map((at) => Number.parseInt(hex.slice(at, at + 2), 16) / 255);
  return { r, g, b, a };
};

/** An entity of a scene that lasts until the next of its name. */
export const entity = (
  given: Pick<SceneEntity, 'id' | 'timestamp' | 'frame_id'> & Partial<SceneEntity>,
): SceneEntity => ({
  lifetime: { sec: 0, nsec: 0 },
  frame_locked: true,
  metadata: [],
  arrows: [],
  cubes: [],
  spheres: [],
  cylinders: [],
  lines: [],
  triangles: [],
  texts: [],
  models: [],
  ...given,
});
