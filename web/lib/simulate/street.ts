import * as glue from '../../wasm/boresight.js';
import { call } from '../runtime/instance.js';
import type { SimulatedStreet, SimulateStreetOptions, StreetOptions, StreetScene } from '../types.js';

/** A street with parked and moving cars, a wall, a guard rail, poles and people around a car with five radars. */
export function streetScene(options?: StreetOptions): StreetScene {
  return call(() => glue.streetScene(options) as StreetScene);
}

/** A frame of one radar of the street; the same bits on every platform. */
export function simulateStreet(options: SimulateStreetOptions): SimulatedStreet {
  return call(() => glue.simulateStreet(options) as SimulatedStreet);
}
