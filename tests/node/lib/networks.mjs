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

/** Confidence below which no card reports a target: such queries are empty, and magnify rounding. */
const EMPTY = 1e-3;

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

/**
 * The same relative to the largest number of its kind (along the last axis) or 1. Of a set of targets, what empty queries
 * answer beside their confidence counts a tenth.
 */
export function differenceByKind(given, { data, shape }, isSet) {
  const kinds = shape[shape.length - 1];
  const scale = new Array(kinds).fill(1);
  data.forEach((value, i) => {
    scale[i % kinds] = Math.max(scale[i % kinds], Math.abs(value));
  });
  let largest = 0;
  data.forEach((value, i) => {
    const kind = i % kinds;
    const empty = isSet && kind !== 2 && data[i - kind + 2] < EMPTY;
    // Not a number is no small difference.
    largest = Math.max(largest, (Math.abs(given[i] - value) / scale[kind]) * (empty ? 0.1 : 1));
  });
  return largest;
}
