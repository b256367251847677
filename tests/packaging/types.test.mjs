import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { root } from '../../scripts/lib/paths.mjs';
import { consumer } from './consumer.mjs';

const { exports } = JSON.parse(readFileSync(join(root, 'package.json'), 'utf8'));

const program = `
  import { BoresightError, Estimator, array, calibrateDrive, estimate, init } from 'boresight';
  import { createPool, type Pool } from 'boresight/worker';
  import { Network, initNeural, type NetworkOptions, type SourceProbabilities } from 'boresight/neural';
  import { createPool as createInline, init as initInline } from 'boresight/inline';
  import { networksModule } from 'boresight/inline/networks';
  import 'boresight/inline/global';
  import type { Drive, DriveCalibration, DriveData, Estimate, EstimatorOptions, Source } from 'boresight';

  await init();
  const options: EstimatorOptions = { method: 'music', array: 'ula8', sources: 2 };
  const data = new Float64Array(2 * array(options.array).positions.length);
  const result: Estimate = estimate({ snapshots: { data, shape: [8, 1] } }, options);
  const strongest: Source | undefined = result.sources[0];
  export const azimuthDeg: number | undefined = strongest?.azimuthDeg;
  const kept = new Estimator(options);
  try {
    kept.estimate({ snapshots: { data, shape: [8, 1] } });
  } catch (error) {
    if (error instanceof BoresightError) console.log(error.code satisfies string);
  } finally {
    kept.free();
  }
  const pool: Pool = createPool({ workers: 1 });
  const later: Estimate = await pool.estimate({ snapshots: { data, shape: [8, 1] } }, options, { signal: AbortSignal.timeout(1000) });
  console.log(later.resolved);
  const mine: DriveData = {
    sensors: [{ id: 1, xM: 3.6, yM: null, yawDeg: null }],
    scans: { timeS: new Float64Array(0), sensor: new Uint8Array(0), offsets: new Uint32Array(1) },
    detections: { azimuthDeg: new Float32Array(0), rangeRateMps: new Float32Array(0) },
    motion: { timeS: new Float64Array(0), yawRateDegps: new Float32Array(0) },
  };
  const here: DriveCalibration = calibrateDrive(mine, { method: 'kabsch' }, (done, total) => done < total);
  const drive: Drive = await pool.simulateDrive({ scenario: 'city', seed: 1n }, { onProgress: (done) => console.log(done) });
  const there: DriveCalibration[] = await pool.jointCalibration(drive, { sensors: [1, { sensor: 2, xM: 3 }] });
  console.log(here.history.angleDeg, there[0]?.frames.verdict);
  await initNeural();
  const given: NetworkOptions = { array: 'lrr48', refine: true, confidence: 0.5 };
  const network = new Network(new Uint8Array(8), given);
  const counted: SourceProbabilities = network.count({ snapshots: { data, shape: [8, 1] } });
  const { id } = await pool.loadNetwork({ onnx: new Uint8Array(8), card: network.card ?? '{}' });
  const found: Estimate = await pool.estimate({ snapshots: { data, shape: [8, 1] } }, { ...options, method: 'dnn', network: id });
  console.log(counted.probability[0], found.warnings, network.run({ x: { data: new Float32Array(1), shape: [1] } })['y']?.shape);
  const hosted: Pool = createPool({
    workers: 0,
    worker: () => new Worker('boresight.worker.js'),
    modules: { core: new URL('https://host/boresight.wasm'), drives: async () => new Uint8Array(8), networks: new Response() },
  });
  await initInline();
  const alone = createInline({ modules: { networks: networksModule } });
  const answer: Estimate = await alone.estimate({ snapshots: { data, shape: [8, 1] } }, options);
  console.log(hosted.workers, answer.resolved, globalThis.boresight.createPool().workers);
  pool.terminate();
`;
const wrong = `
  import { estimate } from 'boresight';
  estimate({ snapshots: { data: [1, 2, 3], shape: [8, 1] } }, { method: 'musik', array: 'ula8' });
`;
const tsconfig = (module, moduleResolution) =>
  JSON.stringify({
    compilerOptions: {
      target: 'ES2022',
      lib: ['ES2022', 'DOM', 'ESNext.Disposable'],
      module,
      moduleResolution,
      strict: true,
      noEmit: true,
      skipLibCheck: false,
      exactOptionalPropertyTypes: true,
      types: [],
    },
    files: ['program.ts'],
  });

let project;
before(
  async () => {
    project = await consumer({
      tools: ['typescript'],
      packages: { '@arethetypeswrong/cli': '~0.18.5' },
      files: {
        'program.ts': program,
        'wrong.ts': wrong,
        'bundler.json': tsconfig('ESNext', 'Bundler'),
        'node16.json': tsconfig('Node16', 'Node16'),
        'nodenext.json': tsconfig('NodeNext', 'NodeNext'),
        'wrong.json': JSON.stringify({ extends: './node16.json', files: ['wrong.ts'] }),
      },
    });
  },
  { timeout: 120_000 },
);
after(() => project?.remove());

for (const resolution of ['bundler', 'node16', 'nodenext']) {
  test(`a strict TypeScript project compiles with moduleResolution ${resolution}`, async () => {
    await project.run(project.bin('tsc'), ['-p', `${resolution}.json`]);
  });
}

test('wrong options do not compile', async () => {
  await assert.rejects(project.run(project.bin('tsc'), ['-p', 'wrong.json']), /wrong\.ts.*error TS2/s);
});

test('attw finds types for every entry, however it is resolved', async () => {
  // What no program imports: modules of WebAssembly, the worker's script, and models.
  const files = Object.keys(exports).filter((name) => /\.wasm$|\.worker\.js$|\*/.test(name));
  const args = ['--profile', 'esm-only', '--exclude-entrypoints', ...files.map((name) => name.replace('./', ''))];
  await project.run(project.bin('attw'), [project.tarball, ...args]);
});
