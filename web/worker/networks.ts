// The networks of a worker: their files as the pool sent them, and in wasm memory those in use.
import { Network, neural } from '../lib/neural/network.js';
import { failure } from '../lib/runtime/errors.js';
import type { NetworkFile, NetworkOptions } from '../lib/types.js';

interface Loaded {
  network: Network;
  /** Number of the instance it lives in. */
  instance: number;
  /** Its options as text. */
  options: string;
}

const files = new Map<string, NetworkFile>();
const loaded = new Map<string, Loaded>();

export function keepNetwork(id: string, file: NetworkFile): void {
  files.set(id, file);
}

export function forgetNetwork(id: string): void {
  files.delete(id);
  // The memory of an instance that is gone went with it.
  loaded.get(id)?.network[Symbol.dispose]();
  loaded.delete(id);
}

/**
 * A network, parsed once and once more after a trap. Options are those of its estimates; without them it keeps the plans
 * made for the last ones, for what estimates by others or not at all.
 */
export function networkWith(id: string, given?: object): Network {
  let one = loaded.get(id);
  if (one?.instance !== neural.number) {
    const file = files.get(id);
    if (!file)
      throw failure('unknown-network', { what: 'network', expected: 'one that the pool has loaded', given: id });
    const { onnx, card } = file;
    one = {
      network: new Network(onnx, { ...(card !== undefined && { card }) }),
      instance: neural.number,
      options: '{}',
    };
    loaded.set(id, one);
  }
  if (!given) return one.network;
  const { network: _, ...options } = given as NetworkOptions & { network?: string };
  const text = keyOf(options);
  if (one.options !== text) {
    one.network.setOptions(options);
    one.options = text;
  }
  return one.network;
}

/** Options as text, equal where they are. */
export function keyOf(options: object): string {
  return JSON.stringify(options, (_, value: unknown) => (typeof value === 'bigint' ? `${value}n` : value));
}
