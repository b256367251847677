/**
 * ROS 2 messages out of CDR, by definitions that stand here: what a server sends as a schema is not used, so that no server
 * says what is read.
 */
import { MessageReader } from '@foxglove/rosmsg2-serialization';
import { MessageProblem } from './problem.ts';
import { schemaOf } from './schemas.ts';

/** Fields as `type name`, those of messages by their whole names, after common_interfaces, radar_msgs and Autoware's. */
const DEFINITIONS: Readonly<Record<string, string>> = {
  'std_msgs/Header': 'time stamp, string frame_id',
  'geometry_msgs/Vector3': 'float64 x, float64 y, float64 z',
  'geometry_msgs/Point': 'float64 x, float64 y, float64 z',
  'geometry_msgs/Quaternion': 'float64 x, float64 y, float64 z, float64 w',
  'geometry_msgs/Pose': 'geometry_msgs/Point position, geometry_msgs/Quaternion orientation',
  'geometry_msgs/PoseWithCovariance': 'geometry_msgs/Pose pose, float64[36] covariance',
  'geometry_msgs/Transform': 'geometry_msgs/Vector3 translation, geometry_msgs/Quaternion rotation',
  'geometry_msgs/TransformStamped': 'std_msgs/Header header, string child_frame_id, geometry_msgs/Transform transform',
  'geometry_msgs/Twist': 'geometry_msgs/Vector3 linear, geometry_msgs/Vector3 angular',
  'geometry_msgs/TwistStamped': 'std_msgs/Header header, geometry_msgs/Twist twist',
  'geometry_msgs/TwistWithCovariance': 'geometry_msgs/Twist twist, float64[36] covariance',
  'geometry_msgs/TwistWithCovarianceStamped': 'std_msgs/Header header, geometry_msgs/TwistWithCovariance twist',
  'nav_msgs/Odometry':
    'std_msgs/Header header, string child_frame_id, geometry_msgs/PoseWithCovariance pose, geometry_msgs/TwistWithCovariance twist',
  'sensor_msgs/Imu':
    'std_msgs/Header header, geometry_msgs/Quaternion orientation, float64[9] orientation_covariance, geometry_msgs/Vector3 angular_velocity, float64[9] angular_velocity_covariance, geometry_msgs/Vector3 linear_acceleration, float64[9] linear_acceleration_covariance',
  'sensor_msgs/PointField': 'string name, uint32 offset, uint8 datatype, uint32 count',
  'sensor_msgs/PointCloud2':
    'std_msgs/Header header, uint32 height, uint32 width, sensor_msgs/PointField[] fields, bool is_bigendian, uint32 point_step, uint32 row_step, uint8[] data, bool is_dense',
  'radar_msgs/RadarReturn':
    'float32 range, float32 azimuth, float32 elevation, float32 doppler_velocity, float32 amplitude',
  'radar_msgs/RadarScan': 'std_msgs/Header header, radar_msgs/RadarReturn[] returns',
  'autoware_vehicle_msgs/VelocityReport':
    'std_msgs/Header header, float32 longitudinal_velocity, float32 lateral_velocity, float32 heading_rate',
  'autoware_auto_vehicle_msgs/VelocityReport':
    'std_msgs/Header header, float32 longitudinal_velocity, float32 lateral_velocity, float32 heading_rate',
  'tf2_msgs/TFMessage': 'geometry_msgs/TransformStamped[] transforms',
};

/** What a message may have behind its last field, which aligns it. */
const PADDING = 3;

type Definition = ConstructorParameters<typeof MessageReader>[0][number];

function definition(name: string): Definition {
  const definitions = (DEFINITIONS[name] ?? '').split(', ').map((field) => {
    const [, type = '', array, length, key = ''] = /^([^[\s]+)(\[(\d*)\])? (\w+)$/.exec(field) ?? [];
    return {
      type,
      name: key,
      isComplex: type.includes('/'),
      isArray: array !== undefined,
      ...(length ? { arrayLength: Number(length) } : {}),
    };
  });
  return { name, definitions };
}

export const isRos2 = (schemaName: string): boolean => Object.hasOwn(DEFINITIONS, schemaOf(schemaName));

const readers = new Map<string, MessageReader>();

/** The message of a schema in bytes of CDR. Throws a `MessageProblem` where they are none. */
export function ros2Message(schemaName: string, bytes: ArrayBufferView): unknown {
  const schema = schemaOf(schemaName);
  if (!isRos2(schema)) throw new MessageProblem('malformed', `${schemaName} is not known`);
  let reader = readers.get(schema);
  if (!reader) {
    const others = Object.keys(DEFINITIONS).filter((name) => name !== schema);
    reader = new MessageReader([schema, ...others].map(definition));
    readers.set(schema, reader);
  }
  let message: unknown;
  try {
    message = reader.readMessage(bytes);
  } catch (error) {
    throw new MessageProblem('malformed', `the bytes are no ${schemaName}: ${(error as Error).message}`);
  }
  const over = bytes.byteLength - reader.lastReadByteLength();
  // Arrays are read out of the buffer, which may go on behind the message.
  if (over < 0) throw new MessageProblem('malformed', `${-over} bytes of a ${schemaName} are missing`);
  if (over > PADDING)
    throw new MessageProblem('malformed', `${over} bytes stand behind a ${schemaName}: it is another version of it`);
  return message;
}
