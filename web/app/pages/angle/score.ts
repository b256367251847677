/** How right a method is on a scene. */
import type { Source } from 'boresight';
import { type Assignment, assign } from './assign.ts';
import type { Scene } from './compute.ts';

/** An estimate within a beam of a target may be the target's. */
export function assigned({ state, geometry }: Scene, sources: readonly Source[]): Assignment {
  return assign(
    state.targets.map(({ azimuthDeg }) => azimuthDeg),
    sources,
    Math.max(geometry.resolutionDeg, 1),
  );
}

export interface Score {
  found: number;
  targets: number;
  /** Root mean square of the errors of those found, degrees; NaN where none is. */
  rmsDeg: number;
  extra: number;
}

export function scoreOf(scene: Scene, sources: readonly Source[]): Score {
  const { matched, extra } = assigned(scene, sources);
  const errors = scene.state.targets.flatMap(({ azimuthDeg }, i) => {
    const source = sources[matched[i] ?? -1];
    return source ? [source.azimuthDeg - azimuthDeg] : [];
  });
  return {
    found: errors.length,
    targets: scene.state.targets.length,
    rmsDeg: rms(errors),
    extra: extra.length,
  };
}

export const rms = (values: readonly number[]): number =>
  values.length ? Math.sqrt(values.reduce((sum, value) => sum + value * value, 0) / values.length) : Number.NaN;
