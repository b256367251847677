import assert from 'node:assert/strict';
import { before, describe, test } from 'node:test';
import { array, arrayPresets, Estimator, estimate, init, methods, version } from 'boresight';
import { batchOf, planeWaves, throwsTyped } from './lib/assert.mjs';

before(() => init());

describe('arrays', () => {
  test('presets are there by name', () => {
    for (const name of [...arrayPresets(), 'ula8']) {
      const { positions, channels, extent } = array(name);
      assert.equal(positions.length, channels.length);
      assert.ok(positions.every((p) => p.length === 3 && p.every(Number.isFinite)));
      assert.notEqual(extent, 'point');
    }
    assert.equal(array('lrr48').positions.length, 48);
    assert.equal(array('lrr48').aperture, 92);
  });

  test('a sparse MIMO array has the sums of its positions', () => {
    const rx = [
      [0, 0, 0],
      [0, 1, 0],
    ];
    const { positions, unambiguousDeg, uniform } = array({
      tx: [
        [0, 0, 0],
        [0, 4, 0],
      ],
      rx,
    });
    assert.deepEqual(
      positions.map((p) => p[1]),
      [0, 1, 4, 5],
    );
    assert.equal(uniform, false);
    assert.equal(unambiguousDeg, 90);
    const repeated = {
      tx: [
        [0, 0, 0],
        [0, 1, 0],
      ],
      rx,
    };
    assert.equal(array(repeated).positions.length, 4);
    assert.equal(array({ ...repeated, withoutDuplicates: true }).positions.length, 3);
    const wide = array({
      positions: [
        [0, 0, 0],
        [0, 2, 0],
      ],
    });
    assert.ok(Math.abs(wide.unambiguousDeg - 30) < 1e-9);
  });

  test('what makes no array is refused with its place', () => {
    throwsTyped(() => array('awr0000'), 'unknown-name', 'array preset');
    throwsTyped(() => array({ positions: [] }), 'empty');
    throwsTyped(
      () =>
        array({
          positions: [
            [0, 0, 0],
            [0, Number.NaN, 0],
          ],
        }),
      'out-of-range',
      'array.positions[1][1]',
    );
    throwsTyped(() => array({ positions: [[0, 0]] }), 'shape', 'array.positions[0]');
    throwsTyped(() => array({ positions: 'ula8' }), 'wrong-type', 'array.positions');
    throwsTyped(() => array({ tx: [[0, 0, 0]] }), 'missing', 'array.rx');
    throwsTyped(() => array({ positions: [[0, 0, 0]], rx: [] }), 'unknown-option', 'array.rx');
    throwsTyped(() => array(7), 'wrong-type', 'array');
    throwsTyped(() => array(), 'wrong-type', 'array');
    throwsTyped(() => array({ positions: Array.from({ length: 1025 }, (_, k) => [0, k, 0]) }), 'out-of-range');
  });
});

describe('estimate', () => {
  const options = { method: 'bartlett', array: 'ula10' };
  const snapshots = planeWaves(10, 100, [-15, 22]);

  test('finds two plane waves', () => {
    const { method, sources, spectrum, resolved, warnings } = estimate({ snapshots }, options);
    assert.equal(method, 'bartlett');
    const angles = sources
      .slice(0, 2)
      .map((s) => s.azimuthDeg)
      .sort((a, b) => a - b);
    // A tenth of the beam width of 10 deg: the beamformer is biased by the other source.
    assert.ok(Math.abs(angles[0] + 15) < 1 && Math.abs(angles[1] - 22) < 1, `${angles}`);
    assert.ok(Math.abs(sources[0].powerDb) < 1, `${sources[0].powerDb}`);
    assert.equal(spectrum.valuesDb.length, spectrum.azimuthDeg.length);
    assert.equal(spectrum.kind, 'power');
    assert.equal(typeof resolved, 'boolean');
    assert.ok(Array.isArray(warnings));
  });

  test('single precision and a kept estimator give the same', () => {
    const single = { data: Float32Array.from(snapshots.data), shape: snapshots.shape };
    const estimator = new Estimator(options);
    const [once, again] = [estimate({ snapshots }, options), estimator.estimate({ snapshots: single })];
    // The two are as strong as each other, so rounding decides which comes first.
    const angles = (result) =>
      result.sources
        .slice(0, 2)
        .map((s) => s.azimuthDeg)
        .sort((x, y) => x - y);
    const [expected, found] = [angles(once), angles(again)];
    assert.ok(
      expected.every((angle, k) => Math.abs(angle - found[k]) < 1e-4),
      `${expected} ${found}`,
    );
    estimator.free();
  });

  test('results belong to the caller', () => {
    const first = estimate({ snapshots }, options).spectrum.valuesDb;
    const copy = first.slice();
    estimate({ snapshots: planeWaves(10, 3, [40]) }, options);
    assert.deepEqual(first, copy);
  });

  test('every method says what it needs', () => {
    const names = methods().map((m) => m.name);
    assert.ok(names.includes('music') && names.length === 20);
    for (const m of methods()) assert.ok(m.title && m.reference && m.cost && m.minSnapshots >= 1, m.name);
  });

  test('bad input is refused by name and leaves the instance working', () => {
    const bad = (change, code, what) =>
      throwsTyped(() => estimate({ snapshots }, { ...options, ...change }), code, what);
    bad({ method: 'musik' }, 'unknown-name', 'method');
    bad({ method: undefined }, 'missing', 'method');
    bad({ method: 3 }, 'wrong-type', 'method');
    bad({ array: undefined }, 'missing', 'array');
    bad({ array: 'ula9' }, 'shape', 'snapshots');
    bad({ gridpoints: 512 }, 'unknown-option', 'gridpoints');
    bad({ gridPoints: 1e12 }, 'out-of-range', 'gridPoints');
    bad({ gridPoints: 2.5 }, 'out-of-range', 'gridPoints');
    bad({ gridPoints: '512' }, 'wrong-type', 'gridPoints');
    bad({ gridPoints: 3 }, 'out-of-range', 'gridPoints');
    bad({ fieldOfViewDeg: 120 }, 'out-of-range', 'fieldOfViewDeg');
    bad({ fieldOfViewDeg: Number.NaN }, 'out-of-range', 'fieldOfViewDeg');
    bad({ sources: 'bic' }, 'unknown-name', 'sources');
    bad({ sources: 0 }, 'out-of-range', 'sources');
    bad({ iaa: { iterations: 0 } }, 'out-of-range', 'iaa.iterations');
    bad({ iaa: { iteration: 3 } }, 'unknown-option', 'iaa.iteration');
    bad({ iaa: 3 }, 'wrong-type', 'iaa');
    const trap = {
      ...options,
      get loading() {
        throw new Error('no');
      },
    };
    throwsTyped(() => estimate({ snapshots }, trap), 'wrong-type', 'loading');
    throwsTyped(() => estimate({ snapshots }), 'wrong-type', 'options');
    throwsTyped(() => estimate({ snapshots }, []), 'wrong-type', 'options');
    assert.ok(estimate({ snapshots }, options).sources.length > 0);
  });

  test('bad data is refused by name and leaves the instance working', () => {
    const bad = (input, code, what) => throwsTyped(() => estimate(input, options), code, what);
    const with_ = (index, value) => {
      const data = snapshots.data.slice();
      data[index] = value;
      return { snapshots: { data, shape: snapshots.shape } };
    };
    bad(undefined, 'wrong-type', 'input');
    bad({}, 'wrong-type', 'input');
    bad({ snapshots, covariance: snapshots, snapshotCount: 3 }, 'wrong-type', 'input');
    bad({ snapshots, extra: 1 }, 'unknown-option', 'input.extra');
    bad({ snapshots: { shape: [10] } }, 'missing', 'input.snapshots.data');
    bad({ snapshots: { data: snapshots.data } }, 'missing', 'input.snapshots.shape');
    bad({ snapshots: { data: [...snapshots.data], shape: [10, 100] } }, 'wrong-type', 'input.snapshots.data');
    bad({ snapshots: { data: new Float64Array(0), shape: [10, 0] } }, 'empty', 'input.snapshots.data');
    bad({ snapshots: { data: snapshots.data, shape: [10, 99] } }, 'shape', 'input.snapshots.data');
    bad({ snapshots: { data: snapshots.data, shape: [10, 1e9] } }, 'shape', 'input.snapshots.data');
    bad({ snapshots: { data: snapshots.data, shape: [10, -100] } }, 'out-of-range', 'input.snapshots.shape[1]');
    bad({ snapshots: { data: snapshots.data, shape: [2, 5, 100] } }, 'shape', 'snapshots');
    bad(with_(7, Number.NaN), 'not-finite', 'snapshots');
    bad(with_(7, Number.POSITIVE_INFINITY), 'not-finite', 'snapshots');
    bad({ covariance: snapshots, snapshotCount: 4 }, 'shape', 'covariance');
    const lent = snapshots.data.slice();
    structuredClone(lent, { transfer: [lent.buffer] });
    bad({ snapshots: { data: lent, shape: snapshots.shape } }, 'empty', 'input.snapshots.data');
    assert.ok(estimate({ snapshots }, options).sources.length > 0);
  });
});

describe('a batch', () => {
  test('gives for each cell what an estimate of it gives, by every method', () => {
    const angles = [[-15, 22], [3], [], [40, -8]];
    for (const { name, minSnapshots, spectrum, network } of methods()) {
      if (network) continue;
      const count = minSnapshots > 1 ? 20 : 1;
      const cells = angles.map((at) => planeWaves(10, count, at));
      const options = { method: name, array: 'ula10', gridPoints: 256, maxIterations: 20 };
      const estimator = new Estimator(options);
      const batch = estimator.estimateBatch({ snapshots: batchOf(cells) }, { spectra: true });
      estimator.free();
      const alone = cells.map((snapshots) => estimate({ snapshots }, options));
      const sources = alone.flatMap((cell) => cell.sources);
      for (const field of ['azimuthDeg', 'elevationDeg', 'powerDb']) {
        assert.deepEqual(
          [...batch[field]],
          sources.map((source) => source[field]),
          `${name} ${field}`,
        );
      }
      assert.deepEqual(
        [...batch.cell],
        alone.flatMap((cell, c) => cell.sources.map(() => c)),
        name,
      );
      assert.equal(batch.method, name);
      assert.equal(batch.unresolved, alone.filter(({ resolved }) => !resolved).length, name);
      assert.equal(batch.spectra !== undefined, spectrum, name);
      if (!spectrum) continue;
      assert.deepEqual(batch.spectra.shape, [4, 256]);
      assert.deepEqual(batch.spectra.azimuthDeg, alone[0].spectrum.azimuthDeg);
      assert.equal(batch.spectra.kind, alone[0].spectrum.kind);
      const loudest = alone[1].spectrum.valuesDb.indexOf(Math.max(...alone[1].spectrum.valuesDb));
      const db = 10 * Math.log10(batch.spectra.power[256 + loudest]);
      // Single precision: 6e-8 of a power are 3e-7 dB.
      assert.ok(Math.abs(db - alone[1].spectrum.valuesDb[loudest]) < 1e-6, name);
    }
  });

  test('of an array that sees elevation has spectra over both angles', () => {
    const estimator = new Estimator({ method: 'bartlett', array: 'awr1843', gridPoints: 64, elevationPoints: 9 });
    const cells = { data: new Float32Array(2 * 3 * 12).fill(1), shape: [3, 12] };
    const { spectra } = estimator.estimateBatch({ snapshots: cells }, { spectra: true });
    estimator.free();
    assert.deepEqual(spectra.shape, [3, 9, 64]);
    assert.deepEqual([spectra.elevationDeg.length, spectra.power.length], [9, 3 * 9 * 64]);
  });

  test('has no spectra of more points than may be kept, and works on', () => {
    const estimator = new Estimator({ method: 'bartlett', array: 'ula4', gridPoints: 65_536 });
    const cells = { data: new Float32Array(2 * 4 * 8000).fill(1), shape: [8000, 4] };
    throwsTyped(() => estimator.estimateBatch({ snapshots: cells }, { spectra: true }), 'too-large', 'the spectra');
    const few = { data: cells.data.subarray(0, 16), shape: [2, 4] };
    assert.deepEqual(estimator.estimateBatch({ snapshots: few }, { spectra: true }).spectra.shape, [2, 65_536]);
    estimator.free();
  });
});

describe('handles', () => {
  const options = { method: 'bartlett', array: 'ula4' };
  const input = { snapshots: planeWaves(4, 1, [10]) };

  test('are freed once and not used afterwards', () => {
    const estimator = new Estimator(options);
    estimator.estimate(input);
    estimator.free();
    throwsTyped(() => estimator.estimate(input), 'handle-freed', 'Estimator');
    throwsTyped(() => estimator.free(), 'handle-freed', 'Estimator');
    estimator[Symbol.dispose]();
  });

  test('that cannot be made leave nothing behind', () => {
    throwsTyped(() => new Estimator({ ...options, gridPoints: 1 }), 'out-of-range', 'gridPoints');
    assert.ok(estimate(input, options).sources.length > 0);
  });
});

test('the version is that of the package', async () => {
  const { default: manifest } = await import('boresight/package.json', { with: { type: 'json' } });
  assert.equal(version(), manifest.version);
});
