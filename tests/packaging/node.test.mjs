import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { consumer } from './consumer.mjs';

let project;
before(async () => {
  project = await consumer({
    fixtures: ['program.mjs'],
    files: {
      'plain.mjs': `
        import * as boresight from 'boresight';
        import { planeWaveAzimuth } from './program.mjs';
        await boresight.init();
        console.log(await planeWaveAzimuth(boresight, 20));
      `,
      'bytes.mjs': `
        import { readFileSync } from 'node:fs';
        import { fileURLToPath } from 'node:url';
        import * as boresight from 'boresight';
        import { planeWaveAzimuth } from './program.mjs';
        boresight.initSync(readFileSync(fileURLToPath(import.meta.resolve('boresight/boresight.wasm'))));
        console.log(await planeWaveAzimuth(boresight, -35));
      `,
      'drives.mjs': `
        import { readFileSync } from 'node:fs';
        import { fileURLToPath } from 'node:url';
        import * as boresight from 'boresight';
        import { createPool } from 'boresight/worker';
        import { simulatedScans } from './program.mjs';
        boresight.initDrivesSync(readFileSync(fileURLToPath(import.meta.resolve('boresight/boresight_drives.wasm'))));
        console.log(await simulatedScans(boresight) === await simulatedScans(createPool({ workers: 1 })));
      `,
      'pool.mjs': `
        import { createPool } from 'boresight/worker';
        import { planeWaveAzimuth } from './program.mjs';
        console.log(await planeWaveAzimuth(createPool({ workers: 2 }), 50));
      `,
      'neural.mjs': `
        import { readFileSync } from 'node:fs';
        import { fileURLToPath } from 'node:url';
        import { initSync, simulateSnapshots } from 'boresight';
        import { Network, initNeuralSync } from 'boresight/neural';
        import { createPool } from 'boresight/worker';
        const file = (name) => readFileSync(fileURLToPath(import.meta.resolve('boresight/' + name)));
        initSync(file('boresight.wasm'));
        initNeuralSync(file('boresight_neural.wasm'));
        const models = ['aaetr-any', 'aaetr-lrr48', 'learned-pursuit'].map((name) => ({
          onnx: file('models/' + name + '.onnx'),
          card: String(file('models/' + name + '.json')),
        }));
        const targets = [{ azimuthDeg: -5 }, { azimuthDeg: 12 }];
        const { data, shape } = simulateSnapshots({ array: 'lrr48', targets, snrDb: 30, seed: 4 });
        const pool = createPool({ workers: 1 });
        for (const model of models) {
          const network = new Network(model.onnx, { card: model.card, array: 'lrr48' });
          const { sources } = network.estimate({ snapshots: { data, shape: shape.slice(1) } });
          const found = sources.map(({ azimuthDeg }) => azimuthDeg.toFixed(0)).sort();
          console.log(network.kind, (await pool.loadNetwork(model)).name, found.join());
        }
      `,
      'uninitialised.mjs': `
        import { BoresightError, estimate } from 'boresight';
        try {
          estimate({}, {});
        } catch (error) {
          console.log(error instanceof BoresightError, error.code);
        }
      `,
    },
  });
});
after(() => project?.remove());

const printed = async (script) => (await project.run(process.execPath, [script])).stdout.trim();
const near = (text, expected) =>
  assert.ok(Math.abs(Number(text) - expected) < 0.1, `${text} deg should be within 0.1 of ${expected}`);

test('an empty Node project imports the package and estimates an angle', async () => {
  near(await printed('plain.mjs'), 20);
});

test('its workers run too, and do not keep the process alive', async () => {
  near(await printed('pool.mjs'), 50);
});

test('the wasm can be had by name and given to initSync', async () => {
  near(await printed('bytes.mjs'), -35);
});

test('the module of drives can be had by name, and a pool loads it by itself', async () => {
  assert.equal(await printed('drives.mjs'), 'true');
});

test('networks are a subpath of their own, and a pool loads their module by itself', async () => {
  assert.deepEqual((await printed('neural.mjs')).split('\n'), [
    'aaetr aaetr-any -5,12',
    'aaetr aaetr-lrr48 -5,12',
    'learned-pursuit learned-pursuit -5,12',
  ]);
});

test('using the package before init() is a typed error', async () => {
  assert.equal(await printed('uninitialised.mjs'), 'true not-initialised');
});
