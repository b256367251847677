/** Servers of the Foxglove WebSocket protocol by the class of its authors, which play the messages of a drive. */
import { createRequire } from 'node:module';
import { parse } from '@foxglove/rosmsg';
import { MessageWriter } from '@foxglove/rosmsg2-serialization';
import { WebSocketServer } from 'ws';

const { FoxgloveServer } = createRequire(import.meta.url)('@foxglove/ws-protocol');

/** Definitions of messages as their packages have them, with all that they are made of. */
const HEADER = `================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp
string frame_id
`;
const VECTOR = `================================================================================
MSG: geometry_msgs/Vector3
float64 x
float64 y
float64 z
`;
const SCHEMAS = {
  'radar_msgs/msg/RadarScan': `std_msgs/Header header
radar_msgs/RadarReturn[] returns
${HEADER}================================================================================
MSG: radar_msgs/RadarReturn
float32 range
float32 azimuth
float32 elevation
float32 doppler_velocity
float32 amplitude
`,
  'nav_msgs/msg/Odometry': `std_msgs/Header header
string child_frame_id
geometry_msgs/PoseWithCovariance pose
geometry_msgs/TwistWithCovariance twist
${HEADER}================================================================================
MSG: geometry_msgs/PoseWithCovariance
geometry_msgs/Pose pose
float64[36] covariance
================================================================================
MSG: geometry_msgs/Pose
geometry_msgs/Point position
geometry_msgs/Quaternion orientation
================================================================================
MSG: geometry_msgs/Point
float64 x
float64 y
float64 z
================================================================================
MSG: geometry_msgs/Quaternion
float64 x
float64 y
float64 z
float64 w
================================================================================
MSG: geometry_msgs/TwistWithCovariance
geometry_msgs/Twist twist
float64[36] covariance
================================================================================
MSG: geometry_msgs/Twist
geometry_msgs/Vector3 linear
geometry_msgs/Vector3 angular
${VECTOR}`,
};

const text = new TextEncoder();

/** How messages of a schema are written: CDR where a definition is known, else JSON. */
function writerOf(schemaName) {
  const schema = SCHEMAS[schemaName];
  if (!schema) return { encoding: 'json', schema: '{}', write: (message) => text.encode(JSON.stringify(message)) };
  const writer = new MessageWriter(parse(schema, { ros2: true }));
  return { encoding: 'cdr', schema, write: (message) => writer.writeMessage(message) };
}

/**
 * A server of some topics, each with its schema. `send` plays messages; `drop` ends all connections as a server that dies
 * does, `close` the server too.
 */
export async function foxgloveServer(topics, { port = 0 } = {}) {
  const server = new FoxgloveServer({ name: 'a car' });
  const sockets = new WebSocketServer({
    host: '127.0.0.1',
    port,
    handleProtocols: (protocols) => server.handleProtocols(protocols),
  });
  await new Promise((resolve, reject) => {
    sockets.once('listening', resolve);
    sockets.once('error', reject);
  });
  const channels = new Map(
    topics.map(({ topic, schemaName }) => {
      const { write, ...how } = writerOf(schemaName);
      return [topic, { id: server.addChannel({ topic, schemaName, ...how }), write }];
    }),
  );
  const subscribed = new Set();
  server.on('subscribe', (id) => subscribed.add(id));
  server.on('unsubscribe', (id) => subscribed.delete(id));
  server.on('error', () => {});
  sockets.on('connection', (socket) => server.handleConnection(socket, 'a page'));
  return {
    server,
    sockets,
    port: sockets.address().port,
    topics: () => [...channels].filter(([, { id }]) => subscribed.has(id)).map(([topic]) => topic),
    send(messages) {
      for (const { topic, timeS, message } of messages) {
        const { id, write } = channels.get(topic);
        server.sendMessage(id, BigInt(Math.round(timeS * 1e9)), write(message));
      }
    },
    /** Plays messages some at a time, with a pause between. */
    async play(messages, { each = 50, pauseMs = 5, until = () => false } = {}) {
      for (let at = 0; at < messages.length && !until(); at += each) {
        this.send(messages.slice(at, at + each));
        await new Promise((resolve) => setTimeout(resolve, pauseMs));
      }
    },
    drop() {
      for (const socket of sockets.clients) socket.terminate();
    },
    async close() {
      this.drop();
      await new Promise((resolve) => sockets.close(resolve));
    },
  };
}
