// Recordings in MCAP as ROS 2 makes them, by @mcap/core: a car that swings left and right past standing things, its radar
// and its motion, and images between. For tests and benchmarks; what is in them is made up.
import { parse } from '@foxglove/rosmsg';
import { MessageWriter } from '@foxglove/rosmsg2-serialization';
import { McapWriter } from '@mcap/core';
import { compress } from 'lz4js';

const LINE = '='.repeat(80);
const TIME = 'MSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec';
const HEADER = `MSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n${LINE}\n${TIME}`;
const VECTOR = 'MSG: geometry_msgs/Vector3\nfloat64 x\nfloat64 y\nfloat64 z';
const QUATERNION = 'MSG: geometry_msgs/Quaternion\nfloat64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1';
const joined = (...parts) => parts.join(`\n${LINE}\n`);

const definitions = {
  'radar_msgs/msg/RadarScan': joined(
    'std_msgs/Header header\nradar_msgs/RadarReturn[] returns',
    HEADER,
    'MSG: radar_msgs/RadarReturn\nfloat32 range\nfloat32 azimuth # Positive angles are anticlockwise.\nfloat32 elevation\nfloat32 doppler_velocity\nfloat32 amplitude',
  ),
  'geometry_msgs/msg/TwistStamped': joined(
    'std_msgs/Header header\ngeometry_msgs/Twist twist',
    HEADER,
    VECTOR,
    'MSG: geometry_msgs/Twist\ngeometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular',
  ),
  'tf2_msgs/msg/TFMessage': joined(
    'geometry_msgs/TransformStamped[] transforms',
    HEADER,
    VECTOR,
    QUATERNION,
    'MSG: geometry_msgs/TransformStamped\nstd_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform',
    'MSG: geometry_msgs/Transform\ngeometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation',
  ),
  'sensor_msgs/msg/Image': joined(
    'std_msgs/Header header\nuint32 height\nuint32 width\nstring encoding\nuint8 is_bigendian\nuint32 step\nuint8[] data',
    HEADER,
  ),
};

/** Where the radar is said to be, and by how much its yaw exceeds that. */
export const RADAR = { topic: '/radar/front', xM: 3.5, offDeg: 2 };
const START_NS = 1_790_000_000_000_000_000n;
const RETURNS = 24;

/** Numbers from 0 to 1, always the same (Park and Miller). */
function numbers(seed) {
  let state = seed;
  return () => {
    state = (state * 48271) % 2147483647;
    return state / 2147483647;
  };
}

/** A `std_msgs/Header` of a time in ns. */
const headerOf = (timeNs, frame_id) => ({
  stamp: { sec: Number(timeNs / 1_000_000_000n), nanosec: Number(timeNs % 1_000_000_000n) },
  frame_id,
});

/** Pixels that pack to about a half. */
function pixels(length, random) {
  const bytes = new Uint8Array(length);
  for (let i = 0; i < length; i++) bytes[i] = i % 64 < 32 ? (random() * 256) | 0 : i % 64;
  return bytes;
}

/**
 * Writes a recording of a 20 Hz radar, with images of `imageBytes` at 10 Hz if that is not 0, to `write`, which takes bytes and
 * may give a promise. `compression` is '' or 'lz4'. Ends after `seconds`, or when `mostBytes` are written. Gives the bytes
 * written, and how many messages each topic has.
 */
export async function writeRecording(write, options = {}) {
  const { seconds = 30, imageBytes = 0, compression = '', mostBytes = Number.POSITIVE_INFINITY, chunkSize } = options;
  let position = 0;
  const writer = new McapWriter({
    writable: {
      position: () => BigInt(position),
      async write(bytes) {
        position += bytes.byteLength;
        // Its buffer is used again.
        await write(bytes.slice());
      },
    },
    ...(chunkSize && { chunkSize }),
    ...(compression && { compressChunk: (bytes) => ({ compression, compressedData: compress(bytes) }) }),
  });
  await writer.start({ profile: 'ros2', library: 'made' });
  const channels = {};
  const writers = {};
  const counts = {};
  const add = async (topic, kind) => {
    writers[topic] = new MessageWriter(parse(definitions[kind], { ros2: true }));
    const data = new TextEncoder().encode(definitions[kind]);
    const schemaId = await writer.registerSchema({ name: kind, encoding: 'ros2msg', data });
    channels[topic] = await writer.registerChannel({ topic, schemaId, messageEncoding: 'cdr', metadata: new Map() });
    counts[topic] = 0;
  };
  await add('/tf_static', 'tf2_msgs/msg/TFMessage');
  await add(RADAR.topic, 'radar_msgs/msg/RadarScan');
  await add('/vehicle/twist', 'geometry_msgs/msg/TwistStamped');
  if (imageBytes) await add('/camera/image', 'sensor_msgs/msg/Image');
  let sequence = 0;
  const message = async (topic, time, content) => {
    counts[topic] += 1;
    const head = { channelId: channels[topic], sequence: sequence++, logTime: time, publishTime: time };
    await writer.addMessage({ ...head, data: writers[topic].writeMessage(content) });
  };
  const transform = { translation: { x: RADAR.xM, y: 0, z: 0.5 }, rotation: { x: 0, y: 0, z: 0, w: 1 } };
  const header = headerOf(START_NS, 'base_link');
  await message('/tf_static', START_NS, { transforms: [{ header, child_frame_id: 'radar', transform }] });
  const random = numbers(7);
  const image = imageBytes ? pixels(imageBytes, random) : null;
  for (let i = 0; i < seconds * 20 && position < mostBytes; i++) {
    const t = i * 0.05;
    const time = START_NS + BigInt(i) * 50_000_000n;
    const yawRate = 0.2 * Math.sin(t / 2);
    const speed = 10 + 3 * Math.sin(t / 5);
    const twist = { linear: { x: speed, y: 0, z: 0 }, angular: { x: 0, y: 0, z: yawRate } };
    await message('/vehicle/twist', time, { header: headerOf(time, 'base_link'), twist });
    const returns = [];
    for (let k = 0; k < RETURNS; k++) {
      const azimuth = ((-55 + 4.7 * k) * Math.PI) / 180;
      const direction = azimuth + (RADAR.offDeg * Math.PI) / 180;
      const rate = -(speed * Math.cos(direction) + yawRate * RADAR.xM * Math.sin(direction));
      const doppler_velocity = rate + (random() - 0.5) * 0.1;
      returns.push({ range: 10 + k, azimuth, elevation: 0, doppler_velocity, amplitude: 20 });
    }
    await message(RADAR.topic, time, { header: headerOf(time, 'radar'), returns });
    if (image && i % 2 === 0) {
      const layout = { height: 1, width: imageBytes, encoding: 'mono8', is_bigendian: 0, step: imageBytes };
      await message('/camera/image', time, { header: headerOf(time, 'camera'), ...layout, data: image });
    }
  }
  await writer.end();
  return { bytes: position, counts };
}

/** A recording in memory. */
export async function recordingBytes(options) {
  const pieces = [];
  await writeRecording((bytes) => pieces.push(bytes), options);
  return Buffer.concat(pieces);
}
