// Requests at and near the ends of what options allow, as calls that take no arguments.
import {
  birdsEyeView,
  cramerRaoBound,
  Estimator,
  methods,
  processCube,
  setLimits,
  simulateCube,
  waveformPreset,
} from '../dist/lib/node.js';

const uniform = (elements) => ({ positions: Array.from({ length: elements }, (_, i) => [0, i, 0]) });
const scattered = (elements) => ({
  positions: Array.from({ length: elements }, (_, i) => [0, i * 0.913 + 0.21 * Math.sin(7 * i), 0]),
});
const filled = (rows) => ({
  positions: Array.from({ length: rows * rows }, (_, i) => [0, i % rows, 0.97 * Math.floor(i / rows)]),
});

/** Six waves and noise. */
function snapshotsOf(positions, count) {
  const data = new Float64Array(2 * positions.length * count);
  for (const [k, [, y, z]] of positions.entries())
    for (let n = 0; n < count; n++) {
      for (let source = 0; source < 6; source++) {
        const phase =
          Math.PI * (y * Math.sin(0.24 * source - 0.6) + z * 0.04 * source) + 17 * Math.sin(n * (source + 2));
        data[2 * (k * count + n)] += Math.cos(phase);
        data[2 * (k * count + n) + 1] += Math.sin(phase);
      }
      data[2 * (k * count + n)] += Math.sin(1e4 * Math.sin(k * 71 + n * 13));
    }
  return { snapshots: { data, shape: [positions.length, count] } };
}

function* estimates() {
  const shapes = [
    ['48 in a line', uniform(48), {}],
    ['256 in a line', uniform(256), {}],
    ['1024 in a line', uniform(1024), {}],
    ['64 scattered', scattered(64), {}],
    ['512 scattered', scattered(512), { gridPoints: 16_384 }],
    ['12 x 12', filled(12), { elevationPoints: 61 }],
    ['30 x 30', filled(30), { elevationPoints: 1024, gridPoints: 4096 }],
  ];
  for (const [shape, elements, options] of shapes) {
    for (const { name, minSnapshots, maxSnapshots, network } of methods()) {
      if (network) continue;
      const snapshots = Math.min(Math.max(minSnapshots, 64), maxSnapshots ?? 64);
      const data = snapshotsOf(elements.positions, snapshots);
      const call = () => new Estimator({ array: elements, method: name, sources: 6, ...options }).estimate(data);
      yield [`${name}, ${shape}`, call];
    }
  }
}

function* batches() {
  const cells = 20_000;
  const snapshots = { data: new Float32Array(2 * 48 * cells).map((_, i) => Math.sin(i * i)), shape: [cells, 48] };
  for (const method of ['bartlett', 'iaa', 'nomp'])
    yield [
      `${method}, ${cells} cells of 48`,
      () => new Estimator({ array: uniform(48), method }).estimateBatch({ snapshots }),
    ];
}

function* rest() {
  const waveform = waveformPreset('awr1642');
  const targets = (count) =>
    Array.from({ length: count }, (_, i) => ({ rangeM: 2 + (i % 10), rateMps: 0, azimuthDeg: 0, powerDb: 0 }));
  for (const count of [1, 64, 1000])
    yield [
      `a cube of ${count} targets, 2 frames`,
      () => simulateCube({ waveform, array: 'awr1642', targets: targets(count), frames: 2, seed: 1 }),
    ];
  let cube;
  const windows = { guardCells: [4, 1], trainingCells: [64, 5], axes: 'both' };
  for (const kind of ['excision', 'cell-averaging', 'ordered-statistic'])
    yield [
      `CFAR, ${kind}, a window of 137 x 13`,
      () => {
        cube ??= simulateCube({ waveform, array: 'awr1642', targets: targets(4), seed: 1 });
        return processCube(cube, { waveform, array: 'awr1642', cfar: { kind, ...windows } });
      },
    ];
  for (const count of [16, 200, 900])
    yield [
      `bound of ${count} targets, 1024 in a line`,
      () =>
        cramerRaoBound({
          array: uniform(1024),
          snapshots: 2000,
          targets: Array.from({ length: count }, (_, i) => ({ azimuthDeg: -80 + (160 * i) / count, snrDb: 10 })),
        }),
    ];
  const axis = (count, at) => Float64Array.from({ length: count }, (_, i) => at(i / (count - 1)));
  const side = 2000;
  const map = {
    rangeM: axis(side, (share) => 200 * share),
    azimuthDeg: axis(side, (share) => (Math.asin(1.8 * share - 0.9) * 180) / Math.PI),
    power: new Float32Array(side * side).fill(1),
    shape: [side, side],
    outside: { count: 0, power: 0 },
  };
  for (const [radars, cellM] of [
    [1, 1],
    [8, 0.1],
    [127, 0.05],
  ])
    yield [
      `view of ${radars} maps of 2000 x 2000, cells of ${cellM} m`,
      () =>
        birdsEyeView({
          radars: Array.from({ length: radars }, () => ({ map, mounting: { xM: 0, yM: 0, yawDeg: 0 } })),
          grid: { xM: [0, 200], yM: [-100, 100], cellM },
        }),
    ];
}

/** The operations that a call says it would take, or the error that comes before; limits are the defaults after it. */
export function operationsOf(call) {
  setLimits({ operations: 1, bytes: 1e15 });
  try {
    call();
    return { operations: 0 };
  } catch (error) {
    return error.code === 'too-large' ? { operations: Number.parseFloat(error.details.given), error } : { error };
  } finally {
    setLimits();
  }
}

export function* requests() {
  yield* estimates();
  yield* batches();
  yield* rest();
}
