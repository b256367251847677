// A program of its own, as what is imported once stays: how a pool loads a network before boresight/neural is imported and after.
import { readFileSync } from 'node:fs';
import { createPool } from 'boresight/worker';

const file = (path) => readFileSync(new URL(`../../../${path}`, import.meta.url));
const onnx = file('models/learned-pursuit.onnx');
const tried = async (pool) =>
  console.log(
    await pool.loadNetwork({ onnx }).then(
      ({ kind }) => kind,
      ({ code }) => code,
    ),
  );

const pool = createPool({ workers: 1 });
await tried(pool);
await tried(createPool({ workers: 1, modules: { networks: file('dist/wasm/boresight_neural_bg.wasm') } }));
await import('boresight/neural');
await tried(pool);
await tried(createPool({ workers: 0 }));
