// `npm run bench`: times the built package, one thread, beside NumPy and fft.js on the same data. How right answers are
// is not measured here: that is `npm run experiments`.
//
//   --only NAMES   rows whose name contains one of these, comma-separated
//   --quick        fewer rounds: for a look, not for figures to keep
//   --json         prints the report as JSON in place of the table (bench.json is written always)
//   --check        exit status 1 where a target is missed, not measured or in error
//   --against FILE exit status 1 where a ratio has fallen beyond three times the noise against that file;
//                  targets, which are for a quiet machine, do not count, and NumPy is not needed
//   --record FILE  writes such a file
//   --model FILES  networks beside the shipped ones, ONNX files, comma-separated
import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { parseArgs } from 'node:util';
import { coreLimits } from '../scripts/lib/checks/sizes.mjs';
import { recorded, regressions } from './baseline.mjs';
import { boardRow } from './boards.mjs';
import { classical, cube, drive, iaa48, scenesOf } from './cases.mjs';
import { makeCube, makeDrive } from './data.mjs';
import { rangeDopplerPlan } from './fft-js.mjs';
import { initSeconds, machine, wasmModule } from './machine.mjs';
import { compare, here, median } from './measure.mjs';
import { networkRows } from './networks.mjs';
import { NumPy } from './numpy.mjs';
import { ransac } from './ransac-js.mjs';
import { recordingRows } from './recordings.mjs';
import { table, tally, verdict } from './report.mjs';

const root = fileURLToPath(new URL('..', import.meta.url));
const { values: options } = parseArgs({
  options: {
    only: { type: 'string' },
    quick: { type: 'boolean', default: false },
    json: { type: 'boolean', default: false },
    check: { type: 'boolean', default: false },
    against: { type: 'string' },
    record: { type: 'string' },
    model: { type: 'string' },
  },
});
const pace = options.quick
  ? { rounds: 30, batchS: 0.004, warmUpS: 0.1, limitS: 1 }
  : { rounds: 400, batchS: 0.004, warmUpS: 0.4, limitS: 4 };
const baseline = options.against && JSON.parse(readFileSync(options.against, 'utf8'));
const wanted = baseline
  ? Object.keys(baseline)
  : options.only
      ?.split(',')
      .map((name) => name.trim())
      .filter(Boolean);
const say = (text) => process.stderr.write(`${text}\n`);

const entry = pathToFileURL(join(root, 'dist', 'lib', 'node.js')).href;
const boresight = await import(entry);
const workerPools = await import(pathToFileURL(join(root, 'dist', 'worker', 'node.js')).href);
const neural = await import(pathToFileURL(join(root, 'dist', 'lib', 'neural', 'node.js')).href);
await Promise.all([boresight.init(), boresight.initDrives()]);
await neural.initNeural();
const shipped = ['models', 'research/models']
  .map((folder) => join(root, folder))
  .flatMap((folder) => readdirSync(folder).map((name) => join(folder, name)))
  .filter((path) => path.endsWith('.onnx'))
  .sort();
const networks = [...shipped, ...(options.model?.split(',') ?? [])];

let numpy;
let withoutNumPy;
try {
  if (!process.env.PYTHON) throw new Error('no Python with NumPy was found');
  numpy = await NumPy.start(process.env.PYTHON);
} catch (error) {
  withoutNumPy = `not measured: ${error.message}`;
  say(`bench: ${withoutNumPy}; ratios to NumPy are left out`);
}

const where = machine();
const rows = [];

/** Runs a row's work if it is wanted; what it throws is the row's result. */
async function row(name, base, work) {
  if (wanted && !wanted.some((part) => name.includes(part))) return;
  say(`bench: ${name}`);
  const own = { name, ...base };
  try {
    Object.assign(own, await work());
  } catch (error) {
    own.error = error.message.split('\n')[0];
  }
  rows.push({ ...own, verdict: verdict(own) });
}

/** The strongest angles of each scene, ascending. */
const strongest = (azimuths, count) => azimuths.slice(0, count).sort((a, b) => a - b);

function largestDifference(ours, theirs, what) {
  let largest = 0;
  for (const [scene, angles] of ours.entries()) {
    if (angles.length !== theirs[scene].length) {
      throw new Error(`${what} finds ${theirs[scene].length} sources where Boresight finds ${angles.length}`);
    }
    angles.forEach((angle, k) => {
      largest = Math.max(largest, Math.abs(angle - theirs[scene][k]));
    });
  }
  return largest;
}

function agree(ours, theirs, limit, what) {
  const difference = largestDifference(ours, theirs, what);
  if (!(difference <= limit)) throw new Error(`${what} differs by ${difference.toPrecision(2)} deg`);
  return difference;
}

const inputsOf = (scenes) => scenes.map(({ data, shape }) => ({ snapshots: { data, shape } }));
const anglesOf = (estimator, inputs, sources) =>
  inputs.map((input) =>
    strongest(
      estimator.estimate(input).sources.map((source) => source.azimuthDeg),
      sources,
    ),
  );

/** Plans a method in NumPy for scenes and returns its angles and a side to time. */
async function numpySide(id, scenes, positions, { method, options: given }, sources) {
  const shape = [scenes.length, ...scenes[0].shape];
  await numpy.prepare(
    'prepare',
    id,
    scenes.map((scene) => scene.data),
    { method, options: given, positions, shape },
  );
  const { azimuthDeg } = await numpy.ask({ do: 'estimate', id });
  return {
    angles: azimuthDeg.map((angles) => strongest(angles, sources)),
    side: (calls) => numpy.seconds(id, calls),
  };
}

async function classicalRow({ name, scenes: what, sources, differDeg, options: given, numpy: theirs }) {
  await row(`${name}, 32 elements`, { unit: 'x', otherName: 'NumPy', target: { least: 1 } }, async () => {
    const scenes = scenesOf(what);
    const inputs = inputsOf(scenes);
    const estimator = new boresight.Estimator(given);
    try {
      const ours = anglesOf(estimator, inputs, sources);
      const errorDeg = largestDifference(
        ours,
        scenes.map((scene) => scene.truthDeg),
        'the truth',
      );
      const own = here((input) => estimator.estimate(input), inputs);
      if (!numpy) {
        const [{ seconds }] = await compare([own], pace);
        return { ours: seconds, errorDeg, missing: withoutNumPy };
      }
      const { angles, side } = await numpySide(name, scenes, what.positions, theirs, sources);
      const differenceDeg = agree(ours, angles, differDeg, 'NumPy');
      const [first, second] = await compare([own, side], pace);
      return {
        ours: first.seconds,
        other: second.seconds,
        ratio: second.ratio,
        value: second.ratio.median,
        differenceDeg,
        errorDeg,
      };
    } finally {
      estimator.free();
    }
  });
}

/** Scenes, over and over, as a batch of `cells`. */
function batchOf(scenes, cells) {
  const size = scenes[0].data.length;
  const data = new Float64Array(cells * size);
  for (let cell = 0; cell < cells; cell++) data.set(scenes[cell % scenes.length].data, cell * size);
  return { snapshots: { data, shape: [cells, ...scenes[0].shape] } };
}

async function iaaRows() {
  const scenes = scenesOf(iaa48.scenes);
  const inputs = inputsOf(scenes);
  const name = 'IAA, lrr48, 1024 angles, 15 iterations';
  const fast = new boresight.Estimator(iaa48.fast);
  const dense = new boresight.Estimator(iaa48.dense);
  const angles = anglesOf(fast, inputs, iaa48.sources);
  const own = here((input) => fast.estimate(input), inputs);
  await row(
    `${name}: beside its dense form`,
    { unit: 'x', otherName: 'dense', target: { least: 20 }, keep: true },
    async () => {
      agree(angles, anglesOf(dense, inputs, iaa48.sources), iaa48.differDeg, 'the dense form');
      const [first, second] = await compare([own, here((input) => dense.estimate(input), inputs)], pace);
      return { ours: first.seconds, other: second.seconds, ratio: second.ratio, value: second.ratio.median };
    },
  );
  await row(`${name}: a snapshot`, { unit: 's', target: { most: 0.7e-3 } }, async () => {
    const [{ seconds }] = await compare([own], pace);
    return { ours: seconds, value: seconds.median };
  });
  const double = new boresight.Estimator({ ...iaa48.fast, iaa: { ...iaa48.fast.iaa, precision: 'double' } });
  await row(`${name}: beside double precision`, { unit: 'x', otherName: 'double', keep: true }, async () => {
    const [first, second] = await compare([own, here((input) => double.estimate(input), inputs)], pace);
    return { ours: first.seconds, other: second.seconds, ratio: second.ratio, value: second.ratio.median };
  });
  double.free();
  await row(`${name}: a cell of a batch of ${iaa48.batch}`, { unit: 's' }, async () => {
    const batch = batchOf(scenes, iaa48.batch);
    const [{ seconds: all }] = await compare([here(() => fast.estimateBatch(batch), [0])], pace);
    const [median, low, high] = [all.median, all.low, all.high].map((time) => time / iaa48.batch);
    return { ours: { median, low, high }, value: median };
  });
  await row(
    `${name}: ${iaa48.cells} cells over two workers, beside one`,
    { unit: 'x', otherName: 'one worker', target: { least: 1.7 } },
    async () => {
      if (where.cores < 2) return { missing: 'not measured: one core' };
      const batch = batchOf(scenes, iaa48.cells);
      const pools = [2, 1].map((workers) => workerPools.createPool({ workers }));
      try {
        const sides = pools.map((pool) => async (calls) => {
          const start = process.hrtime.bigint();
          for (let call = 0; call < calls; call++) await pool.estimateBatch(batch, iaa48.fast);
          return Number(process.hrtime.bigint() - start) / 1e9;
        });
        const [first, second] = await compare(sides, { ...pace, rounds: Math.min(pace.rounds, 20) });
        return { ours: first.seconds, other: second.seconds, ratio: second.ratio, value: second.ratio.median };
      } finally {
        pools.forEach((pool) => pool.terminate());
      }
    },
  );
  if (numpy) {
    await row(`${name}: beside NumPy's fast form`, { unit: 'x', otherName: 'NumPy' }, async () => {
      const theirs = await numpySide('iaa48', scenes, iaa48.scenes.positions, iaa48.numpy('iaa'), iaa48.sources);
      agree(angles, theirs.angles, iaa48.differDeg, 'NumPy');
      const [first, second] = await compare([own, theirs.side], pace);
      return { ours: first.seconds, other: second.seconds, ratio: second.ratio, value: second.ratio.median };
    });
  }
  fast.free();
  dense.free();
}

async function cubeRows() {
  const { loops, channels, samples, cells } = cube;
  const name = `${samples} x ${loops} x ${channels} cube`;
  const { data } = makeCube(cube);
  const planned = (frames) => {
    const all = new Float32Array(frames * data.length);
    for (let frame = 0; frame < frames; frame++) all.set(data, frame * data.length);
    const input = { data: all, shape: [frames, loops, 2, channels / 2, samples] };
    return () => boresight.processCube(input, cube.options);
  };
  const [one, four] = [planned(1), planned(4)];
  const expected = cells.map(([range, doppler]) => [range, (doppler + loops / 2) % loops]);
  const missingIn = (found) =>
    expected.filter((cell) => !found.some((other) => other[0] === cell[0] && other[1] === cell[1]));
  const own = here(one, [0]);
  await row(
    `${name}: windows, FFTs, CFAR and the rest of the chain`,
    { unit: 's', target: { most: 50e-3 } },
    async () => {
      const [frame] = one();
      const missing = missingIn(frame.detections.map((d) => [d.rangeBin, d.dopplerBin]));
      if (missing.length > 0) throw new Error(`targets not detected: ${JSON.stringify(missing)}`);
      const [{ seconds }] = await compare([own], pace);
      return { ours: seconds, value: seconds.median };
    },
  );
  await row(`${name}: the same, four frames in one call, a frame`, { unit: 's' }, async () => {
    const [{ seconds: all }] = await compare([here(four, [0])], pace);
    const seconds = { median: all.median / 4, low: all.low / 4, high: all.high / 4 };
    return { ours: seconds, value: seconds.median };
  });
  if (numpy) {
    await row(`${name}: beside NumPy's windows, FFTs and CFAR`, { unit: 'x', otherName: 'NumPy' }, async () => {
      const { guardCells, trainingCells, falseAlarm } = cube.options.cfar;
      await numpy.prepare('prepare-chain', 'cube', [data], {
        shape: [loops, channels, samples],
        options: { guardCells, trainingCells, falseAlarm },
      });
      const { detections } = await numpy.ask({ do: 'chain', id: 'cube' });
      if (missingIn(detections).length > 0) throw new Error('NumPy misses targets');
      const [first, second] = await compare([own, (calls) => numpy.seconds('cube', calls)], pace);
      return { ours: first.seconds, other: second.seconds, ratio: second.ratio, value: second.ratio.median };
    });
  }
  await row(
    `${name}: beside fft.js, windows and FFTs alone`,
    { unit: 'x', otherName: 'fft.js', keep: true },
    async () => {
      const transform = rangeDopplerPlan(cube);
      const power = transform(data);
      const isPeak = ([range, doppler]) => power[range * loops + doppler] > 0.2 * cube.amplitude ** 2;
      if (!expected.every(isPeak)) throw new Error('fft.js misses targets');
      const [first, second] = await compare([own, here(() => transform(data), [0])], pace);
      return { ours: first.seconds, other: second.seconds, ratio: second.ratio, value: second.ratio.median };
    },
  );
}

/** Frames of a drive as `Calibration` takes them. */
function framesOf({ scans, detections, motion }) {
  return Array.from(motion.timeS, (timeS, scan) => {
    const own = (values) => values.subarray(scans.offsets[scan], scans.offsets[scan + 1]);
    return {
      timeS,
      azimuthDeg: own(detections.azimuthDeg),
      rangeRateMps: own(detections.rangeRateMps),
      yawRateDegps: motion.yawRateDegps[scan],
      speedMps: motion.speedMps[scan],
    };
  });
}

async function driveRows() {
  const { mounting, detections } = drive.make;
  const { drive: made, velocities } = makeDrive({ ...drive.make, scans: drive.frames });
  const frames = framesOf(made);
  const calibration = new boresight.Calibration({
    method: 'weighted-mean',
    motion: 'ransac',
    xM: mounting.xM,
    yM: mounting.yM,
    ...drive.ransac,
  });
  let timeS = 0;
  const take = (frame) => {
    timeS += 1 / 13.5;
    return calibration.addFrame({ ...frame, timeS });
  };
  const apart = (ours, theirs) => ours.map((v, k) => Math.hypot(v[0] - theirs[k][0], v[1] - theirs[k][1]));
  const ours = frames.map((frame) => take(frame).motion.velocityMps);
  const own = here(take, frames);
  const name = `RANSAC motion, ${detections} detections`;
  const asked = { 'plain JavaScript': { target: { least: 1.5 }, keep: true } };
  await row(`${name}: a frame taken by a Calibration`, { unit: 's', target: { most: 100e-6 } }, async () => {
    const error = Math.max(...apart(ours, velocities));
    if (!(error < 0.5)) throw new Error(`a motion is ${error.toPrecision(2)} m/s from the truth`);
    const [{ seconds }] = await compare([own], pace);
    return { ours: seconds, value: seconds.median };
  });
  const beside = (otherName, side, theirs) =>
    row(`${name}: beside ${otherName}`, { unit: 'x', otherName, ...asked[otherName] }, async () => {
      const differences = apart(ours, await theirs());
      const [typical, largest] = [median(differences), Math.max(...differences)];
      if (!(typical <= drive.differMps.median && largest <= drive.differMps.most)) {
        throw new Error(`${otherName} differs by ${typical.toPrecision(2)}, at most ${largest.toPrecision(2)} m/s`);
      }
      const [first, second] = await compare([own, side], pace);
      return { ours: first.seconds, other: second.seconds, ratio: second.ratio, value: second.ratio.median };
    });
  if (numpy) {
    const values = new Float64Array(2 * detections * frames.length);
    frames.forEach((frame, index) => {
      values.set(
        Float64Array.from(frame.azimuthDeg, (deg) => (deg * Math.PI) / 180),
        2 * detections * index,
      );
      values.set(frame.rangeRateMps, 2 * detections * index + detections);
    });
    await beside(
      'NumPy',
      (calls) => numpy.seconds('motion', calls),
      async () => {
        await numpy.prepare('prepare-motion', 'motion', [values], {
          shape: [frames.length, 2, detections],
          options: drive.ransac,
        });
        return (await numpy.ask({ do: 'motion', id: 'motion' })).velocityMps;
      },
    );
  }
  const plain = ransac(drive.ransac, detections);
  const run = ({ azimuthDeg, rangeRateMps }) => plain(azimuthDeg, rangeRateMps);
  await beside('plain JavaScript', here(run, frames), () => frames.map((frame) => run(frame).velocity));
  calibration.free();
  const hours = boresight.calibrationMethods().map(({ name }) => [name, detections, 10]);
  // As many as a front radar of RadarScenes has.
  for (const [method, each, most] of [...hours, ['recursive', 225, 20]]) {
    await row(
      `an hour of one radar, ${drive.hour} frames of ${each}: ${method}`,
      { unit: 's', target: { most } },
      () => {
        const { drive: hour } = makeDrive({ ...drive.make, detections: each, scans: drive.hour });
        // Too long to be repeated: processor time, which other processes hardly change.
        const start = process.cpuUsage();
        const { result } = boresight.calibrateDrive(hour, { method });
        const { user, system } = process.cpuUsage(start);
        const value = (user + system) / 1e6;
        const error = Math.abs(result.angleDeg - mounting.trueYawDeg);
        if (!(error < Math.max(4 * result.sigmaDeg, 0.01)))
          throw new Error(`off by ${error.toPrecision(2)} +- ${result.sigmaDeg.toPrecision(2)} deg`);
        return { value };
      },
    );
  }
}

async function boundaryRows() {
  const { options: given, scenes: what } = classical.find(({ name }) => name === 'bartlett, 1 snapshot');
  const inputs = inputsOf(scenesOf(what));
  await row(
    'one call of estimate() beside a kept Estimator (bartlett, 1 snapshot)',
    { unit: 'x', otherName: 'estimate()', keep: true },
    async () => {
      const estimator = new boresight.Estimator(given);
      const kept = here((input) => estimator.estimate(input), inputs);
      const [first, second] = await compare([kept, here((input) => boresight.estimate(input, given), inputs)], pace);
      estimator.free();
      return { ours: first.seconds, other: second.seconds, ratio: second.ratio, value: second.ratio.median };
    },
  );
  await row('crossing the boundary and back (bartlett, 4 elements, 16 angles)', { unit: 's' }, async () => {
    const estimator = new boresight.Estimator({ method: 'bartlett', array: 'ula4', gridPoints: 16 });
    const input = { snapshots: { data: new Float64Array([1, 0, 1, 0, 1, 0, 1, 0]), shape: [4] } };
    const [{ seconds }] = await compare([here(() => estimator.estimate(input), [0])], pace);
    estimator.free();
    return { ours: seconds, value: seconds.median };
  });
}

const wasm = wasmModule(join(root, 'dist', 'wasm', 'boresight_bg.wasm'));
const neuralModule = () => wasmModule(join(root, 'dist', 'wasm', 'boresight_neural_bg.wasm'));
await iaaRows();
for (const one of classical) await classicalRow(one);
await cubeRows();
await driveRows();
await boundaryRows();
await recordingRows({ row, boresight, quick: options.quick });
await boardRow({ row, pace, boresight });
await networkRows(networks, { row, pace, neural, positions: boresight.array('lrr48').positions });
await row('init() in a fresh process', { unit: 's' }, () => ({ value: initSeconds(entry, options.quick ? 3 : 15) }));
await row('core .wasm, raw', { unit: 'bytes' }, () => ({ value: wasm.bytes }));
await row('core .wasm, Brotli', { unit: 'bytes', target: { most: coreLimits.brotli } }, () => ({
  value: wasm.brotliBytes,
}));
await row('neural .wasm, raw', { unit: 'bytes' }, () => ({ value: neuralModule().bytes }));
await row('neural .wasm, Brotli', { unit: 'bytes', target: { most: 3_000_000 } }, () => ({
  value: neuralModule().brotliBytes,
}));

const report = {
  date: new Date().toISOString(),
  quick: options.quick,
  machine: where,
  numpy: numpy?.versions ?? null,
  wasm,
  rows,
};
numpy?.stop();
writeFileSync(join(root, 'bench.json'), `${JSON.stringify(report, null, 2)}\n`);
const counts = tally(rows);
if (options.json) {
  console.log(JSON.stringify(report, null, 2));
} else {
  const { cpu, node, load, cores } = where;
  const beside = report.numpy ? `NumPy ${report.numpy.numpy} (${report.numpy.blas})` : 'no NumPy';
  console.log(`\n${cpu}, Node ${node}, ${beside}, one thread; wasm ${wasm.sha256.slice(0, 12)}`);
  console.log(
    `load ${load.toFixed(1)} on ${cores} cores at the start${load > 0.75 * cores ? ': not quiet, times are too long; ratios hold better' : ''}\n`,
  );
  console.log(table(rows));
  console.log(
    `\ntargets: ${counts.met} met, ${counts.missed} missed, ${counts.errors} in error, ${counts.notMeasured} not measured`,
  );
}
if (options.record) writeFileSync(options.record, `${JSON.stringify(recorded(rows), null, 2)}\n`);
if (baseline) {
  const lines = regressions(rows, baseline);
  for (const line of lines) say(`bench: slower: ${line}`);
  if (lines.length > 0) process.exitCode = 1;
}
if (options.check && counts.missed + counts.errors + counts.notMeasured > 0) process.exitCode = 1;
