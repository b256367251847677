/**
 * Simulated frames as the bytes of boards, written here by the tables of docs/formats.md and not by the package, and the
 * configurations they were "recorded" with. No recording of these boards was at hand.
 */
import { simulateCube } from 'boresight';

const LINES = ['dfeDataOutputMode 1', 'profileCfg 0 77 40 7 57.14 0 0 60 1 128 5209 0 0 30', 'lowPower 0 1'];

/** A configuration: what is real, which lanes, and which chips. */
export function configOf({ real = false, lanes = 2, iqSwap = 0, transmitters = [0, 1], cascade = false, loops = 16 }) {
  const masks = cascade ? '65535 4095 1' : '15 3 0';
  return [
    ...(cascade ? [] : [`% Platform:${lanes === 4 ? 'xWR14xx' : 'xWR16xx'}`]),
    `channelCfg ${masks}`,
    `adcCfg 2 ${real ? 0 : 1}`,
    `adcbufCfg -1 ${Number(real)} ${iqSwap} ${lanes === 4 || cascade ? 0 : 1} 0`,
    ...LINES,
    ...transmitters.map((tx, i) => `chirpCfg ${i} ${i} 0 0 0 0 0 ${1 << tx}`),
    `frameCfg 0 ${transmitters.length - 1} ${loops} 0 100 1 0`,
    '',
  ].join('\n');
}

/** Transmitters of the cascade's row, from left to right. */
export const ROW = [11, 10, 9, 8, 7, 6, 5, 4, 3];
/** Receivers of the cascade from left to right, by chip and number on it: the third slave, the master, the second, the first. */
const CHIP_AT = [3, 0, 2, 1];
const CHIP_NAMES = ['master', 'slave1', 'slave2', 'slave3'];

export const TARGETS = [
  { rangeM: 0.12, azimuthDeg: 0, powerDb: 6, phaseDeg: 0 },
  { rangeM: 2.5, azimuthDeg: -20, rateMps: 0, powerDb: 0, phaseDeg: 40 },
];

/** Frames of the targets, seen by the array of a configuration. */
export function framesOf(waveform, array, frames = 2) {
  return simulateCube({ waveform, array, targets: TARGETS, snrDb: 10, seed: 3, frames });
}

const numbers = ({ data }) => Int16Array.from(data, (x) => Math.round(600 * x));
const bytesOf = (values) => new Uint8Array(Int16Array.from(values).buffer);

/** All chirps of a cube: their receivers' samples as [i, q]. */
function* chirpsOf(cube) {
  const [frames, loops, transmitters, receivers, samples] = cube.shape;
  const values = numbers(cube);
  for (let chirp = 0; chirp < frames * loops * transmitters; chirp++) {
    const at = (rx, n) => 2 * ((chirp * receivers + rx) * samples + n);
    yield { receivers, samples, i: (rx, n) => values[at(rx, n)], q: (rx, n) => values[at(rx, n) + 1] };
  }
}

const upTo = (count) => Array.from({ length: count }, (_, k) => k);

export function twoLane(cube, real = false) {
  const words = [];
  for (const { receivers, samples, i, q } of chirpsOf(cube)) {
    for (const rx of upTo(receivers)) {
      if (real) words.push(...upTo(samples).map((n) => i(rx, n)));
      else
        for (const n of upTo(samples / 2)) words.push(i(rx, 2 * n), i(rx, 2 * n + 1), q(rx, 2 * n), q(rx, 2 * n + 1));
    }
  }
  return bytesOf(words);
}

export function fourLane(cube, real = false) {
  const words = [];
  for (const { receivers, samples, i, q } of chirpsOf(cube)) {
    for (const n of upTo(samples)) {
      words.push(...upTo(receivers).map((rx) => i(rx, n)));
      if (!real) words.push(...upTo(receivers).map((rx) => q(rx, n)));
    }
  }
  return bytesOf(words);
}

/** The files of the four chips. */
export function cascadeFiles(cube) {
  return CHIP_NAMES.map((name, chip) => {
    const first = 4 * CHIP_AT.indexOf(chip);
    const words = [];
    for (const { samples, i, q } of chirpsOf(cube)) {
      for (const n of upTo(samples)) for (const rx of upTo(4)) words.push(i(first + rx, n), q(first + rx, n));
    }
    return { name: `${name}_0000_data.bin`, bytes: bytesOf(words) };
  });
}

/** The index beside a chip's data. */
export function indexOf({ name, bytes }, frames) {
  const index = new DataView(new ArrayBuffer(24 + 48 * frames));
  index.setUint32(12, frames, true);
  index.setBigUint64(16, BigInt(bytes.length), true);
  for (const k of upTo(frames)) {
    index.setUint32(24 + 48 * k + 28, bytes.length / frames, true);
    index.setBigUint64(24 + 48 * k + 32, BigInt(100_000 * k), true);
  }
  return { name: name.replace('data', 'idx'), bytes: new Uint8Array(index.buffer) };
}
