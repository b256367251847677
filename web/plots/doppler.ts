/** Range rates of what stands, seen by a radar that moves. */

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
