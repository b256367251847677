import assert from 'node:assert/strict';
import { before, test } from 'node:test';
import { countSources, cramerRaoBound, init } from 'boresight';
import { planeWaves, throwsTyped } from './lib/assert.mjs';

before(() => init());

test('one source: the bound is the closed form', () => {
  // Stoica and Nehorai 1989, eq. (5.2): var(w) = 6 / (N snr m (m^2 - 1)) for w = pi sin(azimuth).
  const [m, snapshots, snr] = [10, 100, 100];
  const target = { azimuthDeg: 20, snrDb: 20 };
  const { azimuthDeg, elevationDeg } = cramerRaoBound({
    array: 'ula10',
    targets: [target],
    snapshots,
    kind: 'deterministic',
  });
  const deviation = Math.sqrt(6 / (snapshots * snr * m * (m * m - 1))) / (Math.PI * Math.cos((20 * Math.PI) / 180));
  assert.ok(Math.abs(azimuthDeg[0] / ((deviation * 180) / Math.PI) - 1) < 1e-9, `${azimuthDeg[0]}`);
  assert.equal(elevationDeg, undefined);
  const stochastic = cramerRaoBound({ array: 'ula10', targets: [target], snapshots, kind: 'stochastic' });
  // The stochastic bound is larger by 1 + 1 / (m snr) in variance for one source.
  assert.ok(Math.abs(stochastic.azimuthDeg[0] / azimuthDeg[0] - Math.sqrt(1 + 1 / (m * snr))) < 1e-9);
});

test('planar arrays have a bound of elevation too', () => {
  const { elevationDeg } = cramerRaoBound({ array: 'awr1843', targets: [{ azimuthDeg: 5, snrDb: 10 }], snapshots: 4 });
  assert.equal(elevationDeg.length, 1);
});

test('what has no bound is refused', () => {
  const options = { array: 'ula4', targets: [{ azimuthDeg: 0, snrDb: 0 }], snapshots: 1 };
  const bad = (change, code, what) => throwsTyped(() => cramerRaoBound({ ...options, ...change }), code, what);
  bad({ targets: [] }, 'empty');
  bad({ targets: [0, 1, 2, 3].map((k) => ({ azimuthDeg: k, snrDb: 0 })) }, 'too-many-sources', 'sources');
  bad({ targets: [{ azimuthDeg: 91, snrDb: 0 }] }, 'out-of-range', 'targets[0].azimuthDeg');
  bad({ targets: [{ azimuthDeg: 0 }] }, 'missing', 'targets[0].snrDb');
  bad({ targets: [{ azimuthDeg: 0, snrDb: 1e9 }] }, 'out-of-range', 'targets[0].snrDb');
  bad({ snapshots: 0 }, 'out-of-range', 'snapshots');
  bad({ kind: 'bayesian' }, 'unknown-name', 'kind');
});

test('two plane waves count as two', () => {
  const input = { snapshots: planeWaves(8, 64, [-20, 25]) };
  for (const options of [undefined, {}, { criterion: 'mdl', forwardBackward: true }]) {
    const { count, eigenvalues, criterion } = countSources(input, options);
    assert.equal(count, 2);
    assert.equal(eigenvalues.length, 8);
    assert.ok(eigenvalues[1] > 1e6 * eigenvalues[2]);
    if (options?.criterion) assert.equal(criterion.indexOf(Math.min(...criterion)), 2);
    else assert.ok(criterion.length === 2 && criterion.every((ratio) => ratio > 1));
  }
  const single = { snapshots: planeWaves(8, 1, [-20]) };
  throwsTyped(() => countSources(single), 'snapshot-count', 'snapshots');
  throwsTyped(() => countSources(input, { criterion: 'bic' }), 'unknown-name', 'criterion');
  throwsTyped(() => countSources({}), 'wrong-type', 'input');
});
