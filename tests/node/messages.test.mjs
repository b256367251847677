/** What reads messages of viewers and follows a drive by them (web/messages), against definitions of ROS and the package itself. */
import assert from 'node:assert/strict';
import { rmSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { MessageWriter } from '@foxglove/rosmsg2-serialization';
import * as boresight from 'boresight';
import fc from 'fast-check';
import { root } from '../../scripts/lib/paths.mjs';
import { outputFolder } from '../browser/lib/session.mjs';
import { drive, messages, pointCloud, radarScan } from '../viewers/messages.mjs';

const require = createRequire(import.meta.url);
const { ros2humble } = createRequire(require.resolve('@foxglove/schemas'))('@foxglove/rosmsg-msgs-common');
const folder = join(outputFolder, 'messages');
const NAMES = ['scan', 'motion', 'places', 'ros2', 'follow', 'weigh'];
let read;

before(async () => {
  const { build } = await import('vite');
  const entry = Object.fromEntries(NAMES.map((name) => [name, join(root, 'web', 'messages', `${name}.ts`)]));
  await build({
    configFile: false,
    root,
    logLevel: 'warn',
    build: {
      target: 'es2022',
      minify: false,
      outDir: folder,
      emptyOutDir: true,
      lib: { entry, formats: ['es'] },
      rolldownOptions: { external: ['boresight'] },
    },
  });
  const all = await Promise.all(NAMES.map((name) => import(pathToFileURL(join(folder, `${name}.js`)))));
  read = Object.assign({}, ...all);
});
after(() => rmSync(folder, { recursive: true, force: true }));

const near = (given, wanted, within) =>
  assert.ok(Math.abs(given - wanted) <= within, `${given} is ${wanted} to ${within}`);

/** A definition of ROS and all that it is made of, as the writer takes them. */
function definitions(name) {
  const found = new Map();
  const take = (type) => {
    if (found.has(type)) return;
    const definition = ros2humble[type];
    assert.ok(definition, type);
    found.set(type, definition);
    for (const field of definition.definitions) if (field.isComplex) take(field.type);
  };
  take(name);
  return [...found.values()];
}

/** A message with numbers in all its fields. */
function filled(name, seed = 1) {
  let next = seed;
  const value = (type) => {
    next += 1;
    if (type === 'string') return `name ${next}`;
    if (type === 'bool') return next % 2 === 0;
    if (type === 'time') return { sec: next, nanosec: next + 1 };
    return /^u?int/.test(type) ? next % 100 : next / 4;
  };
  const made = (type) =>
    Object.fromEntries(
      ros2humble[type].definitions
        .filter(({ isConstant }) => !isConstant)
        .map(({ name: key, type: kind, isComplex, isArray, arrayLength }) => {
          const one = () => (isComplex ? made(kind) : value(kind));
          return [key, isArray ? Array.from({ length: arrayLength ?? 3 }, one) : one()];
        }),
    );
  return made(name);
}

const plain = (value) =>
  JSON.parse(JSON.stringify(value, (_, one) => (ArrayBuffer.isView(one) ? Array.from(one) : one)));

for (const name of [
  'nav_msgs/Odometry',
  'geometry_msgs/Twist',
  'geometry_msgs/TwistStamped',
  'geometry_msgs/TwistWithCovarianceStamped',
  'sensor_msgs/Imu',
  'sensor_msgs/PointCloud2',
  'tf2_msgs/TFMessage',
]) {
  test(`${name} is read as ROS 2 defines it`, () => {
    const wanted = filled(name);
    const bytes = new MessageWriter(definitions(name)).writeMessage(wanted);
    const given = read.ros2Message(name.replace('/', '/msg/'), bytes);
    assert.deepEqual(plain(given), plain(wanted));
    const longer = new Uint8Array(bytes.length + 8);
    longer.set(bytes);
    assert.throws(() => read.ros2Message(name, longer), /another version/);
    assert.throws(() => read.ros2Message(name, bytes.subarray(0, bytes.length - 9)), { code: 'malformed' });
  });
}

test('any bytes are a message or a problem with it', () => {
  const schemas = [
    'radar_msgs/msg/RadarScan',
    'sensor_msgs/msg/PointCloud2',
    'tf2_msgs/msg/TFMessage',
    'std_msgs/msg/Header',
  ];
  fc.assert(
    fc.property(fc.constantFrom(...schemas), fc.uint8Array({ maxLength: 200 }), (schema, bytes) => {
      try {
        read.ros2Message(schema, bytes);
      } catch (error) {
        assert.equal(error.code, 'malformed');
      }
    }),
    { seed: 1, numRuns: 2000 },
  );
});

test('anything is a scan, a motion, places, or a problem with it', () => {
  const schemas = [
    'radar_msgs/RadarScan',
    'sensor_msgs/PointCloud2',
    'foxglove.PointCloud',
    'nav_msgs/Odometry',
    'tf2_msgs/TFMessage',
    'foxglove.FrameTransform',
    'boresight.CarMotion',
    'x',
  ];
  const words = [
    'header',
    'returns',
    'fields',
    'data',
    'point_step',
    'point_stride',
    'width',
    'height',
    'name',
    'offset',
    'datatype',
    'type',
    'x',
    'twist',
    'linear',
    'transforms',
    'translation',
    'stamp',
    'sec',
  ];
  const value = fc.letrec((tie) => ({
    any: fc.oneof(
      { depthSize: 'medium' },
      fc.constantFrom(null, undefined, 0, -1, 1, 4, 8, 1e308, Number.NaN, 'x', 'AAAAAAAA', 3n, new Uint8Array(64)),
      fc.array(tie('any'), { maxLength: 4 }),
      fc.dictionary(fc.constantFrom(...words), tie('any'), { maxKeys: 8 }),
    ),
  })).any;
  fc.assert(
    fc.property(fc.constantFrom(...schemas), value, (schema, message) => {
      for (const work of [
        () => read.scanOf(schema, message),
        () => read.motionOf(schema, message),
        () => new read.Places().take(schema, message),
      ]) {
        try {
          work();
        } catch (error) {
          assert.match(error.code ?? String(error), /^(malformed|no-field|too-large)$/);
        }
      }
    }),
    { seed: 2, numRuns: 3000 },
  );
});

/** A cloud of points of some kinds of numbers; `big` endian where asked for. */
function cloud2(fields, rows, big = false) {
  const kinds = {
    int8: [1, 1],
    uint8: [2, 1],
    int16: [3, 2],
    uint16: [4, 2],
    int32: [5, 4],
    uint32: [6, 4],
    float32: [7, 4],
    float64: [8, 8],
  };
  // One byte before the first field, and one behind each.
  let at = 1;
  const placed = fields.map(([name, kind]) => {
    const [datatype, bytes] = kinds[kind];
    const field = { name, kind, datatype, count: 1, offset: at };
    at += bytes + 1;
    return field;
  });
  const data = new DataView(new ArrayBuffer(at * rows.length + 3));
  const write = (kind) => `set${kind[0].toUpperCase()}${kind.slice(1)}`;
  rows.forEach((row, i) => {
    placed.forEach(({ kind, offset }, column) => void data[write(kind)](i * at + offset, row[column], !big));
  });
  return {
    header: { stamp: { sec: 3, nanosec: 500_000_000 }, frame_id: 'radar' },
    height: 1,
    width: rows.length,
    fields: placed.map(({ kind: _, ...field }) => field),
    is_bigendian: big,
    point_step: at,
    row_step: at * rows.length,
    data: new Uint8Array(data.buffer),
    is_dense: true,
  };
}

test('clouds are read in every kind of number, in either order of bytes, by places or angles', () => {
  const rows = [
    [3, 4, -2],
    [5, -12, 7],
  ];
  for (const kind of ['int8', 'int16', 'int32', 'float32', 'float64']) {
    for (const big of [false, true]) {
      const message = cloud2(
        [
          ['x', kind],
          ['y', kind],
          ['radial_velocity', kind],
        ],
        rows,
        big,
      );
      const { timeS, frameId, azimuthDeg, rangeM, rangeRateMps } = read.scanOf('sensor_msgs/msg/PointCloud2', message);
      assert.deepEqual([timeS, frameId, [...rangeM], [...rangeRateMps]], [3.5, 'radar', [5, 13], [-2, 7]], kind);
      near(azimuthDeg[0], (Math.atan2(4, 3) * 180) / Math.PI, 1e-12);
    }
  }
  // Velocities along the ray: what a point of (vx, vy) comes nearer by.
  const split = read.scanOf(
    'sensor_msgs/PointCloud2',
    cloud2(
      [
        ['x', 'float64'],
        ['y', 'float64'],
        ['vx', 'float64'],
        ['vy', 'float64'],
      ],
      [[3, 4, 1, 2]],
    ),
  );
  near(split.rangeRateMps[0], (1 * 3 + 2 * 4) / 5, 1e-12);
  const signs = { azimuth: -1, rangeRate: -1 };
  const polar = read.scanOf(
    'sensor_msgs/PointCloud2',
    cloud2(
      [
        ['azimuth', 'float64'],
        ['range', 'float32'],
        ['doppler', 'int16'],
      ],
      [[0.5, 8, 3]],
    ),
    signs,
  );
  near(polar.azimuthDeg[0], (-0.5 * 180) / Math.PI, 1e-12);
  assert.deepEqual([polar.rangeM[0], polar.rangeRateMps[0]], [8, -3]);
});

test('what `boresight serve` packs and what RadarScan has are the same scan', async () => {
  const { frames } = await drive({ durationS: 2 });
  const [ours, ros] = [
    read.scanOf('foxglove.PointCloud', pointCloud(frames[3])),
    read.scanOf('radar_msgs/RadarScan', radarScan(frames[3])),
  ];
  assert.equal(ours.azimuthDeg.length, frames[3].azimuthDeg.length);
  near(ours.timeS, ros.timeS, 1e-9);
  for (const name of ['azimuthDeg', 'rangeRateMps', 'rangeM'])
    frames[3][name].forEach((value, i) => {
      near(ours[name][i], value, 1e-5);
      near(ros[name][i], value, 1e-5);
    });
});

test('motion is read in each kind of message, and needs a yaw rate', () => {
  const DEG = 180 / Math.PI;
  const twist = { linear: { x: 7, y: 0, z: 0 }, angular: { x: 0, y: 0, z: 0.1 } };
  const stamped = { header: { stamp: { sec: 2, nanosec: 250_000_000 } } };
  for (const [schema, message, speed] of [
    ['nav_msgs/msg/Odometry', { ...stamped, twist: { twist } }, 7],
    ['geometry_msgs/msg/TwistWithCovarianceStamped', { ...stamped, twist: { twist } }, 7],
    ['geometry_msgs/msg/TwistStamped', { ...stamped, twist }, 7],
    ['geometry_msgs/msg/Twist', twist, 7],
    ['autoware_vehicle_msgs/msg/VelocityReport', { ...stamped, longitudinal_velocity: 7, heading_rate: 0.1 }, 7],
    ['sensor_msgs/msg/Imu', { ...stamped, angular_velocity: twist.angular }, Number.NaN],
    [
      'foxglove.Odometry',
      { timestamp: { sec: 2, nsec: 250_000_000 }, linear_velocity: twist.linear, angular_velocity: twist.angular },
      7,
    ],
    ['boresight.CarMotion', { timestamp: { sec: 2, nsec: 250_000_000 }, speedMps: 7, yawRateDegps: 0.1 * DEG }, 7],
  ]) {
    assert.ok(read.hasMotion(schema), schema);
    const { timeS, yawRateDegps, speedMps } = read.motionOf(schema, message);
    assert.deepEqual([timeS, speedMps], [message === twist ? Number.NaN : 2.25, speed], schema);
    near(yawRateDegps, 0.1 * DEG, 1e-12);
  }
  assert.throws(() => read.motionOf('boresight.CarMotion', { speedMps: 7 }), { code: 'no-field' });
  assert.throws(() => read.motionOf('sensor_msgs/Imu', {}), { code: 'malformed' });
});

/** Feeds messages in their order; gives what was told. */
function followed(all, options, change = (one) => one) {
  const told = { angles: [], scans: [], restarts: 0 };
  const follower = new read.Follower(options, {
    scan: (one) => told.scans.push(one),
    angle: (timeS, result) => told.angles.push([timeS, result]),
    restarted: () => {
      told.restarts += 1;
    },
  });
  for (const { schemaName, message, timeS } of all.map(change)) {
    // A time of zero is none: that of the message is taken.
    if (read.hasScans(schemaName)) follower.addScan(read.scanOf(schemaName, message));
    else follower.addMotion({ ...read.motionOf(schemaName, message), timeS });
  }
  const counts = { ...follower.counts, waiting: follower.waiting };
  const result = follower.estimate();
  follower.free();
  return { ...told, counts, result };
}

const PLACE = { xM: 3.6, yM: 0.7, nominalDeg: 30 };

test('a drive that is followed gives what it gives as a whole', async () => {
  const made = await drive({ durationS: 30 });
  const { result, counts, scans } = followed(messages(made), PLACE);
  const whole = boresight.calibrateDrive(made.drive, { sensor: 1, ...PLACE }).result;
  // The last scan may wait for a motion that does not come.
  assert.equal(counts.scans, made.frames.length);
  assert.ok(counts.waiting <= 1);
  assert.deepEqual([counts.late, counts.refused, counts.restarts], [0, 0, 0]);
  near(result.angleDeg, whole.angleDeg, 0.01);
  near(result.sigmaDeg, whole.sigmaDeg, 0.002);
  // The motion at each scan is the one that is interpolated over the whole drive; times are of nanoseconds.
  scans.forEach(({ frame }, i) => {
    const wanted = made.frames[i];
    assert.equal(frame.yawRateDegps === null, wanted.yawRateDegps === null, `scan ${i}`);
    if (wanted.yawRateDegps === null) return;
    near(frame.yawRateDegps, wanted.yawRateDegps, 1e-4);
    near(frame.speedMps, wanted.speedMps, 1e-4);
  });
});

test('what is late, without a time, or without motion is counted; times that run back begin anew', async () => {
  const made = await drive({ durationS: 10 });
  const all = messages(made);
  const isScan = ({ topic }) => topic === '/radar/scan';
  const swapped = [...all];
  const at = swapped.findIndex((one, i) => i > 300 && isScan(one));
  const after = swapped.findIndex((one, i) => i > at && isScan(one));
  [swapped[at], swapped[after]] = [swapped[after], swapped[at]];
  const late = followed(swapped, PLACE);
  assert.deepEqual([late.counts.late, late.counts.restarts], [1, 0]);
  const timeless = followed(all, PLACE, (one) =>
    isScan(one) ? { ...one, message: { ...one.message, header: {} } } : one,
  );
  assert.deepEqual([timeless.counts.late, timeless.result.frames.given], [made.frames.length, 0]);
  const alone = followed(all.filter(isScan), PLACE);
  assert.equal(alone.result.frames.withoutMotion, alone.result.frames.given);
  assert.ok(alone.result.frames.given > made.frames.length - 6);
  const twice = followed([...all, ...all], PLACE);
  assert.deepEqual([twice.restarts, twice.counts.restarts], [1, 1]);
  near(twice.result.angleDeg, followed(all, PLACE).result.angleDeg, 1e-9);
  // A gap in the motion is not bridged.
  const gap = followed(
    all.filter((one) => isScan(one) || one.timeS < 4 || one.timeS > 6),
    PLACE,
  );
  near(gap.result.frames.withoutMotion, 2 * 13.5, 4);
});

test('scan by scan the radar moves as the car carries it', async () => {
  const made = await drive({ durationS: 60 });
  const weigher = new read.Weigher();
  let told = 0;
  for (const message of messages(made).filter(({ topic }) => topic === '/radar/scan')) {
    const outcome = weigher.weigh(read.scanOf(message.schemaName, message.message));
    assert.ok(outcome);
    if (outcome.motion) told += 1;
  }
  // More scans than it keeps.
  assert.ok(made.frames.length > 600 && told > 0.9 * made.frames.length, `${told} of ${made.frames.length}`);
  const first = read.scanOf('radar_msgs/RadarScan', radarScan(made.frames[20]));
  assert.ok(weigher.weigh(first)?.motion, 'times may run back');
  weigher.free();
});
