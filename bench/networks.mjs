// Networks: our module beside onnxruntime-web, one thread each, the same ONNX files and inputs.
import { readFileSync } from 'node:fs';
import { basename } from 'node:path';
import { generator } from '../scripts/lib/build/generator.mjs';
import { compare, here, median } from './measure.mjs';

const BATCHES = [1, 32];
/** Largest difference, relative to the largest number or 1, at which the two count as the same. */
const DIFFER = 1e-4;

/** Inputs of a network for a batch: positions are those of `lrr48`, all else is drawn. */
function inputsOf(ports, batch, positions) {
  const draw = generator(7);
  return Object.fromEntries(
    ports.map(({ name, axes }) => {
      const shape = axes.map((axis) =>
        typeof axis === 'number' ? axis : axis === 'elements' ? positions.length : batch,
      );
      const data = new Float32Array(shape.reduce((product, length) => product * length, 1));
      for (let i = 0; i < data.length; i++)
        data[i] = name === 'positions' ? positions[Math.trunc(i / 3)][i % 3] : 2 * draw() - 1;
      return [name, { data, shape }];
    }),
  );
}

function agree(ours, theirs) {
  for (const [name, { data }] of Object.entries(ours)) {
    const other = theirs[name].data;
    let [largest, scale] = [0, 1];
    data.forEach((value, i) => {
      const apart = Math.abs(value - other[i]);
      largest = Math.max(largest, apart);
      scale = Math.max(scale, Math.abs(other[i]));
    });
    if (!(largest <= DIFFER * scale))
      throw new Error(`${name} differs from onnxruntime-web's by ${(largest / scale).toPrecision(2)}`);
  }
}

const timed = async (work) => {
  const start = process.hrtime.bigint();
  const result = await work();
  return [Number(process.hrtime.bigint() - start) / 1e9, result];
};

/** Rows for the files of networks; `row` and `pace` are those of main.mjs. */
export async function networkRows(files, { row, pace, neural, positions }) {
  let ort;
  const runtime = async () => {
    if (ort) return ort;
    ort = await import('onnxruntime-web/wasm');
    ort.env.wasm.numThreads = 1;
    return ort;
  };
  for (const file of files) {
    const name = `network ${basename(file, '.onnx')}`;
    const bytes = new Uint8Array(readFileSync(file));
    await row(`${name}: from its bytes to ready`, { unit: 's', target: { most: 1 } }, async () => {
      const times = [];
      for (let round = 0; round < 5; round++) {
        const [seconds, network] = await timed(() => new neural.Network(bytes));
        times.push(seconds);
        network.free();
      }
      // The first is what a user waits for: the engine has not yet optimised the module's code.
      return { value: times[0], again: median(times) };
    });
    for (const batch of BATCHES) {
      await row(
        `${name}: batch of ${batch}`,
        { unit: 'x', otherName: 'onnxruntime-web', target: { least: 1 }, keep: true },
        async () => {
          const { InferenceSession, Tensor } = await runtime();
          const network = new neural.Network(bytes);
          const session = await InferenceSession.create(bytes, {
            executionProviders: ['wasm'],
            graphOptimizationLevel: 'all',
          });
          try {
            const inputs = inputsOf(network.inputs, batch, positions);
            const feeds = Object.fromEntries(
              Object.entries(inputs).map(([port, { data, shape }]) => [port, new Tensor('float32', data, shape)]),
            );
            agree(network.run(inputs), await session.run(feeds));
            const theirs = async (calls) =>
              (
                await timed(async () => {
                  for (let call = 0; call < calls; call++) await session.run(feeds);
                })
              )[0];
            const [first, second] = await compare([here(() => network.run(inputs), [0]), theirs], pace);
            const each = ({ seconds: { best, median: middle, low, high } }) => ({
              best: best / batch,
              median: middle / batch,
              low: low / batch,
              high: high / batch,
            });
            return { ours: each(first), other: each(second), ratio: second.ratio, value: second.ratio.median };
          } finally {
            network.free();
            await session.release();
          }
        },
      );
    }
  }
}
