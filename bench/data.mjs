// Seeded scenes: both sides of every comparison get the same numbers.

/** Uniform numbers in [0, 1) from a 32-bit seed (mulberry32). */
export function uniform(seed) {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let t = state;
    t = Math.imul(t ^ (t >>> 15), t | 1);
    t ^= t + Math.imul(t ^ (t >>> 7), t | 61);
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

/** Circular complex normal numbers of a given power, as [re, im]. */
function complexNormal(random, power) {
  const radius = Math.sqrt(-power * Math.log(1 - random()));
  const phase = 2 * Math.PI * random();
  return [radius * Math.cos(phase), radius * Math.sin(phase)];
}

/**
 * Scenes of `u.length` sources of 0 dB around the given sines of azimuth, each moved by up to
 * `jitter`: complex Gaussian over snapshots, or of constant modulus in a single one.
 */
export function makeScenes({ positions, u, jitter, snrDb, snapshots, scenes, seed }) {
  const random = uniform(seed);
  const elements = positions.length;
  const noise = 10 ** (-snrDb / 10);
  return Array.from({ length: scenes }, () => {
    const data = new Float64Array(2 * elements * snapshots);
    const sines = u.map((centre) => centre + jitter * (2 * random() - 1));
    for (const sine of sines) {
      for (let t = 0; t < snapshots; t++) {
        const phase = 2 * Math.PI * random();
        const [re, im] = snapshots === 1 ? [Math.cos(phase), Math.sin(phase)] : complexNormal(random, 1);
        positions.forEach((position, k) => {
          const [cos, sin] = [Math.cos(Math.PI * position * sine), Math.sin(Math.PI * position * sine)];
          const at = 2 * (k * snapshots + t);
          data[at] += re * cos - im * sin;
          data[at + 1] += re * sin + im * cos;
        });
      }
    }
    for (let i = 0; i < data.length; i += 2) {
      const [re, im] = complexNormal(random, noise);
      data[i] += re;
      data[i + 1] += im;
    }
    const truthDeg = sines.map((sine) => (Math.asin(sine) * 180) / Math.PI).sort((a, b) => a - b);
    return { data, shape: [elements, snapshots], truthDeg };
  });
}

/** Noise with tones in given cells: loops x channels x samples of interleaved float32. */
export function makeCube({ loops, channels, samples, cells, amplitude, seed }) {
  const random = uniform(seed);
  const data = new Float32Array(2 * loops * channels * samples);
  let at = 0;
  for (let loop = 0; loop < loops; loop++) {
    for (let channel = 0; channel < channels; channel++) {
      for (let sample = 0; sample < samples; sample++, at += 2) {
        let [re, im] = complexNormal(random, 1);
        for (const [range, doppler] of cells) {
          const phase = 2 * Math.PI * ((range * sample) / samples + (doppler * loop) / loops);
          re += amplitude * Math.cos(phase);
          im += amplitude * Math.sin(phase);
        }
        data[at] = re;
        data[at + 1] = im;
      }
    }
  }
  return { data, shape: [loops, channels, samples] };
}

/**
 * A drive of one radar at 13.5 Hz on a winding road, `moving` of its detections with a range rate of their
 * own: the drive as `calibrateDrive` takes it, and the radar's true velocity in each scan.
 */
export function makeDrive({ scans, detections, moving, mounting, noise, seed }) {
  const random = uniform(seed);
  const normal = () => complexNormal(random, 2)[0];
  const yaw = (mounting.trueYawDeg * Math.PI) / 180;
  const total = scans * detections;
  const [azimuthDeg, rangeRateMps] = [new Float32Array(total), new Float32Array(total)];
  const [timeS, yawRateDegps, speedMps] = [0, 1, 2].map(() => new Float64Array(scans));
  const velocities = [];
  for (let scan = 0, at = 0; scan < scans; scan++) {
    timeS[scan] = scan / 13.5;
    speedMps[scan] = 12 + 4 * Math.sin(timeS[scan] / 7);
    const rate = 0.25 * Math.sin(timeS[scan] / 5);
    yawRateDegps[scan] = ((rate + 0.001 * normal()) * 180) / Math.PI;
    const [u, v] = [speedMps[scan] - rate * mounting.yM, rate * mounting.xM];
    const [vx, vy] = [Math.cos(yaw) * u + Math.sin(yaw) * v, Math.cos(yaw) * v - Math.sin(yaw) * u];
    velocities.push([vx, vy]);
    for (let k = 0; k < detections; k++, at++) {
      const azimuth = 2 * random() - 1;
      const own = random() < moving ? 30 * (random() - 0.5) : 0;
      rangeRateMps[at] = own - vx * Math.cos(azimuth) - vy * Math.sin(azimuth) + noise.rangeRateMps * normal();
      azimuthDeg[at] = (azimuth * 180) / Math.PI + noise.azimuthDeg * normal();
    }
  }
  const offsets = Uint32Array.from({ length: scans + 1 }, (_, scan) => scan * detections);
  const { id, xM, yM, yawDeg } = mounting;
  return {
    drive: {
      sensors: [{ id, xM, yM, yawDeg }],
      scans: { timeS, sensor: new Uint8Array(scans).fill(id), offsets },
      detections: { azimuthDeg, rangeRateMps },
      motion: { timeS, yawRateDegps, speedMps },
    },
    velocities,
  };
}
