/** A capture that is simulated in the page: what a board that sees elevation would record of a street. */
import type { CubeTarget, RadarConfig } from 'boresight';
import { api, pool } from '../../../data.ts';

export const SIMULATED = { bin: 'simulated-awr1843.bin', cfg: 'simulated-awr1843.cfg' } as const;

/** Three transmitters of an AWR1843 in turn, 9 cm and 0.16 m/s a bin, unambiguous to 23 m and ±2.6 m/s; six frames. */
const CFG = `% Simulated in the page, recorded by no board
% Platform:xWR18xx
channelCfg 15 7 0
adcCfg 2 1
adcbufCfg -1 0 0 1 1
profileCfg 0 77 40 6 60 0 0 33 1 256 5000 0 0 30
chirpCfg 0 0 0 0 0 0 0 1
chirpCfg 1 1 0 0 0 0 0 2
chirpCfg 2 2 0 0 0 0 0 4
frameCfg 0 2 32 6 200 1 0
`;
const FRAMES = 6;
const FULL_SCALE = 32_768;

/** Something of the street: where from the radar, m, and how it moves forward, m/s. */
type Thing = readonly [xM: number, yM: number, zM: number, forwardMps: number, powerDb: number];

/** The radar is 1.5 m over the road. What stands is at ranges half a metre apart, so that cells hold one thing each. */
const THINGS: readonly Thing[] = [
  // A sign over the road, askew, with its posts.
  ...[-3.6, -1.8, 0, 1.8, 3.6].map((y): Thing => [17 + 0.32 * y, y, 4.2, 0, -10]),
  ...[-1, 0.9, 2.8].map((z, i): Thing => [14.2 - 0.5 * i, -5.2, z, 0, -16]),
  ...[-1, 0.9, 2.8].map((z, i): Thing => [18.6 + 0.35 * i, 5, z, 0, -14]),
  // A car in front, driving on.
  [9.4, 0.9, -0.9, 1.4, -9],
  [9.9, -0.7, -0.4, 1.4, -9],
  [11.6, 0.2, 0.1, 1.4, -14],
  // One parked at the left.
  [6, 3.9, -1, 0, -10],
  [7.4, 4.2, -0.2, 0, -12],
  [9, 4, -0.9, 0, -13],
  // Somebody who comes closer: head, body, and a leg each way.
  [6.4, -2.6, 0.25, -1.1, -18],
  [6.4, -2.6, -0.4, -1.45, -14],
  [6.3, -2.5, -1.2, -2.2, -18],
  [6.5, -2.7, -1.2, -0.4, -18],
  // A lamp over the pavement, and a bollard.
  [11.2, -5.8, 3.6, 0, -14],
  [4.4, -2.4, -1.2, 0, -14],
  // Kerbs.
  [3.4, 2.9, -1.5, 0, -16],
  [3.2, -2.2, -1.5, 0, -16],
];

/** The samples as a capture card records them, and the configuration. */
export async function simulateCapture(): Promise<{ bin: Uint8Array; cfg: string }> {
  const { waveform } = api.parseConfig(CFG) as RadarConfig;
  const targets = THINGS.map(([xM, yM, zM, forwardMps, powerDb]): CubeTarget => {
    const rangeM = Math.hypot(xM, yM, zM);
    return {
      rangeM,
      rateMps: (forwardMps * xM) / rangeM,
      azimuthDeg: degrees(Math.atan2(yM, xM)),
      elevationDeg: degrees(Math.asin(zM / rangeM)),
      powerDb: powerDb - 12,
    };
  });
  const { data } = await pool().simulateCube({
    waveform,
    array: 'awr1843',
    targets,
    frames: FRAMES,
    snrDb: 24,
    seed: 1843,
  });
  return { bin: recorded(data), cfg: CFG };
}

/** Complex samples as a DCA1000 records them: two real parts, then their imaginary parts, in 16 bits. */
export function recorded(samples: Float32Array): Uint8Array {
  const words = new Int16Array(samples.length);
  const word = (value = 0): number => Math.min(Math.max(Math.round(value * FULL_SCALE), -FULL_SCALE), FULL_SCALE - 1);
  for (let i = 0; i < samples.length; i += 4) {
    words[i] = word(samples[i]);
    words[i + 1] = word(samples[i + 2]);
    words[i + 2] = word(samples[i + 1]);
    words[i + 3] = word(samples[i + 3]);
  }
  return new Uint8Array(words.buffer);
}

const degrees = (radians: number): number => (radians * 180) / Math.PI;
