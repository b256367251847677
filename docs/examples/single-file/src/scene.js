export const TRUTH_DEG = [-12, 20];

/** Two targets before an array of eight elements, as two methods see them. */
export async function estimates(pool) {
  const targets = TRUTH_DEG.map((azimuthDeg) => ({ azimuthDeg }));
  const scene = { array: 'ula8', targets, snapshots: 50, snrDb: 20, seed: 1 };
  const { data, shape } = await pool.simulateSnapshots(scene);
  const snapshots = { data, shape: shape.slice(-2) };
  const methods = ['capon', 'music'];
  return Promise.all(methods.map((method) => pool.estimate({ snapshots }, { array: 'ula8', method, sources: 2 })));
}
