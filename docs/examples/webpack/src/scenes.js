const ARRAY = 'ula8';
const AZIMUTH_DEG = 10;
const SCENES = 400;

/** RMSE of MUSIC over scenes with one target, degrees. */
export async function rmseDeg(pool, snrDb, job) {
  const targets = [{ azimuthDeg: AZIMUTH_DEG }];
  const scenes = { array: ARRAY, targets, snapshots: 16, snrDb, scenes: SCENES, seed: 1 };
  const { data, shape } = await pool.simulateSnapshots(scenes);
  const { azimuthDeg } = await pool.estimateBatch(
    { snapshots: { data, shape } },
    { array: ARRAY, method: 'music', sources: 1 },
    job,
  );
  return Math.sqrt(azimuthDeg.reduce((sum, found) => sum + (found - AZIMUTH_DEG) ** 2, 0) / azimuthDeg.length);
}
