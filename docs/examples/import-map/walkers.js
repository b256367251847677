const MOUNTING = { xM: 3.6, yM: 0, yawDeg: 0 };

/** A frame of a radar with two walkers before it, one of them at `rangeM`: range and Doppler, and from above. */
export async function pictures(pool, rangeM) {
  const radar = { waveform: await pool.waveformPreset('awr1642'), array: 'awr1642' };
  const targets = [
    { rangeM, azimuthDeg: -20, rateMps: -1.5 },
    { rangeM: 8, azimuthDeg: 25, rateMps: 1.2 },
  ];
  const cube = await pool.simulateCube({ ...radar, targets, snrDb: 0, seed: 1 });
  const [[frame], { map }] = await Promise.all([
    pool.processCube(cube, radar),
    pool.imageFrame(cube, { ...radar, angle: { method: 'bartlett' } }),
  ]);
  const grid = { xM: [0, 15], yM: [-10, 10], cellM: 0.1 };
  const view = await pool.birdsEyeView({ radars: [{ map, mounting: MOUNTING }], grid });
  return { frame, view };
}
