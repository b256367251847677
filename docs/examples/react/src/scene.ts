import type { Estimate } from 'boresight';
import type { Pool } from 'boresight/worker';

/** The target that stays where it is. */
export const OTHER_DEG = 20;

/** Two targets before an array of eight elements, as three methods see them. */
export async function estimates(pool: Pool, azimuthDeg: number, signal?: AbortSignal): Promise<Estimate[]> {
  const job = signal ? { signal } : {};
  const targets = [{ azimuthDeg }, { azimuthDeg: OTHER_DEG }];
  const scene = { array: 'ula8', targets, snapshots: 50, snrDb: 20, seed: 1 } as const;
  const { data, shape } = await pool.simulateSnapshots(scene, job);
  const snapshots = { data, shape: shape.slice(-2) };
  const methods = ['bartlett', 'capon', 'music'] as const;
  return Promise.all(methods.map((method) => pool.estimate({ snapshots }, { array: 'ula8', method, sources: 2 }, job)));
}
