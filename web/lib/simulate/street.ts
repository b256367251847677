import * as glue from '../../wasm/boresight.js';
import { call } from '../runtime/instance.js';
import type { SimulatedStreet, SimulateStreetOptions, StreetOptions, StreetScene } from '../types.js';

/** A street with parked and moving cars, a wall, a guard rail, poles and people around a car with five radars. */
export function streetScene(options?: StreetOptions): StreetScene {
  return call(() => glue.streetScene(options) as StreetScene);
}

/**
 * A frame of one radar of the street; the same bits on every platform.
 *
 * @example
 * ```js
 * import { birdsEyeView, imageFrame, init, simulateStreet } from 'boresight';
 *
 * await init();
 * const { cube, radar } = simulateStreet({ radar: 'front-left', seed: 1 });
 * const { data, shape } = cube;
 * const { array, waveform, mounting } = radar;
 * const { map } = imageFrame({ data, shape }, { array, waveform, angle: { method: 'bartlett' } });
 * const grid = { xM: [0, 50], yM: [-25, 25], cellM: 0.5 };
 * const { power } = birdsEyeView({ radars: [{ map, mounting }], grid });
 * console.log(power.length); // → 10000
 * ```
 */
export function simulateStreet(options: SimulateStreetOptions): SimulatedStreet {
  return call(() => glue.simulateStreet(options) as SimulatedStreet);
}
