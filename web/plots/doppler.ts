/** Range rates of what stands, seen by a radar that moves. */
import type { Place } from './car.ts';

/** A radar's velocity in its own frame: along boresight and to its left, m/s. */
export interface Motion {
  vxMps: number;
  vyMps: number;
}

/** Range rate of what stands, seen from a moving radar. */
export function standingRate({ vxMps, vyMps }: Motion, azimuthDeg: number): number {
  const azimuth = (azimuthDeg * Math.PI) / 180;
  return -(vxMps * Math.cos(azimuth) + vyMps * Math.sin(azimuth));
}

/** A radar's motion as the car carries it: of the speed of the rear axle and the yaw rate. */
export function carriedMotion({ xM, yM, yawDeg }: Place, speedMps: number, yawRateDegps: number): Motion {
  const rate = (yawRateDegps * Math.PI) / 180;
  const [x, y] = [speedMps - rate * yM, rate * xM];
  const [cos, sin] = [Math.cos((yawDeg * Math.PI) / 180), Math.sin((yawDeg * Math.PI) / 180)];
  return { vxMps: cos * x + sin * y, vyMps: cos * y - sin * x };
}
