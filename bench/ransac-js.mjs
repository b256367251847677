// A radar's motion by RANSAC as one would write it without Boresight: double precision, typed arrays made
// once, draws cut short as soon as enough agree.
import { uniform } from './data.mjs';

/** Returns a function from azimuths (deg) and range rates to velocity, covariance and inliers of a frame. */
export function ransac({ inlierResidualMps, confidence, inlierRatioThreshold }, most) {
  const [cos, sin, closing] = [0, 1, 2].map(() => new Float64Array(most));
  const random = uniform(1);
  const draws = (share) => Math.ceil(Math.log1p(-confidence) / Math.log1p(-share * share));

  function count(count, vx, vy) {
    let agreeing = 0;
    for (let k = 0; k < count; k++) {
      if (Math.abs(closing[k] - vx * cos[k] - vy * sin[k]) < inlierResidualMps) agreeing++;
    }
    return agreeing;
  }

  /** Least squares on what agrees with a velocity. */
  function fit(count, vx, vy) {
    let [xx, xy, yy, dx, dy, dd, used] = [0, 0, 0, 0, 0, 0, 0];
    for (let k = 0; k < count; k++) {
      const [c, s, d] = [cos[k], sin[k], closing[k]];
      if (Math.abs(d - vx * c - vy * s) < inlierResidualMps) {
        xx += c * c;
        xy += c * s;
        yy += s * s;
        dx += c * d;
        dy += s * d;
        dd += d * d;
        used++;
      }
    }
    const determinant = xx * yy - xy * xy;
    const velocity = [(yy * dx - xy * dy) / determinant, (xx * dy - xy * dx) / determinant];
    const variance = (dd - velocity[0] * dx - velocity[1] * dy) / (used - 2) / determinant;
    return {
      velocity,
      covariance: [
        [yy * variance, -xy * variance],
        [-xy * variance, xx * variance],
      ],
      inliers: used,
    };
  }

  return (azimuthDeg, rangeRateMps) => {
    const total = azimuthDeg.length;
    for (let k = 0; k < total; k++) {
      const azimuth = (azimuthDeg[k] * Math.PI) / 180;
      cos[k] = Math.cos(azimuth);
      sin[k] = Math.sin(azimuth);
      closing[k] = -rangeRateMps[k];
    }
    let best = { agreeing: 0, vx: 0, vy: 0 };
    let needed = draws(inlierRatioThreshold);
    for (let draw = 0; draw < needed; draw++) {
      const i = Math.floor(random() * total);
      const j = (i + 1 + Math.floor(random() * (total - 1))) % total;
      const determinant = cos[i] * sin[j] - sin[i] * cos[j];
      if (Math.abs(determinant) < 0.01) continue;
      const vx = (closing[i] * sin[j] - closing[j] * sin[i]) / determinant;
      const vy = (closing[j] * cos[i] - closing[i] * cos[j]) / determinant;
      const agreeing = count(total, vx, vy);
      if (agreeing > best.agreeing) {
        best = { agreeing, vx, vy };
        needed = Math.min(needed, draws(agreeing / total));
      }
    }
    let found = fit(total, best.vx, best.vy);
    for (let round = 0; round < 6; round++) {
      const next = fit(total, ...found.velocity);
      const settled = next.velocity[0] === found.velocity[0] && next.velocity[1] === found.velocity[1];
      found = next;
      if (settled) break;
    }
    const weights = new Float32Array(total);
    const [vx, vy] = found.velocity;
    for (let k = 0; k < total; k++)
      weights[k] = Math.abs(closing[k] - vx * cos[k] - vy * sin[k]) < inlierResidualMps ? 1 : 0;
    return { ...found, weights };
  };
}
