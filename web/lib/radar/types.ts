/** What a radar is: its array, its waveform, its place on the car. */

/** Antenna position in half wavelengths: x forward, y left, z up. */
export type Position = readonly [x: number, y: number, z: number];

/**
 * A preset's name (`lrr48`, `awr1642`, `awr1843`, `iwr6843isk`, `iwr6843aop`, `iwr6843ods`, `cascade86`, `ula8` for any N) or
 * positions.
 */
export type ArrayInput =
  | string
  | { positions: readonly Position[] }
  | { tx: readonly Position[]; rx: readonly Position[]; withoutDuplicates?: boolean };
