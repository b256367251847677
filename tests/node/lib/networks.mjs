// The trained networks and what PyTorch says of a batch for each.
import { readdirSync, readFileSync } from 'node:fs';
import { readNpy } from 'boresight';

const models = new URL('../../../models/', import.meta.url);
const goldens = new URL('../../golden/networks/', import.meta.url);

/** Names of the shipped networks. */
export const names = readdirSync(models)
  .filter((name) => name.endsWith('.onnx'))
  .map((name) => name.slice(0, -5))
  .sort();

/** File and card of a network. */
export function model(name) {
  const onnx = new Uint8Array(readFileSync(new URL(`${name}.onnx`, models)));
  return { onnx, card: readFileSync(new URL(`${name}.json`, models), 'utf8') };
}

/** A tensor of a network's golden batch. */
export function tensor(name, port) {
  const { data, shape } = readNpy(readFileSync(new URL(`${name}/${port}.npy`, goldens)));
  return { data: Float32Array.from(data), shape };
}

/** The largest difference, relative to the largest number or 1. */
export function difference(given, expected) {
  let [largest, scale] = [0, 1];
  expected.forEach((value, i) => {
    // Not a number is no small difference.
    const apart = Math.abs(given[i] - value);
    largest = Math.max(largest, apart);
    scale = Math.max(scale, Math.abs(value));
  });
  return largest / scale;
}
