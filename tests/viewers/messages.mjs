/** A simulated drive as the messages that cars send: those of ROS, or those of `boresight serve`. */
import { driveFrame, initDrives, scanMotion, simulateDrive } from 'boresight';

const RAD = Math.PI / 180;

/** A time of messages: ROS 2 has `nanosec`, Foxglove `nsec`. */
export const stamp = (timeS, fraction = 'nanosec') => {
  const nanoseconds = BigInt(Math.round(timeS * 1e9));
  return { sec: Number(nanoseconds / 1_000_000_000n), [fraction]: Number(nanoseconds % 1_000_000_000n) };
};

/** A drive of one radar, and the frames that a calibration is given of it. */
export async function drive({ durationS = 60, seed = 3, sensor = { id: 1, xM: 3.6, yM: 0.7, yawDeg: 30.5 } } = {}) {
  await initDrives();
  const made = simulateDrive({ scenario: 'city', durationS, seed, sensors: [sensor] });
  const motion = scanMotion(made);
  const frames = Array.from(made.scans.timeS, (_, scan) => driveFrame(made, scan, motion));
  return { drive: made, frames, sensor };
}

/** radar_msgs/RadarScan. */
export const radarScan = ({ timeS, azimuthDeg, rangeRateMps, rangeM }, { azimuth = 1, rangeRate = 1 } = {}) => ({
  header: { stamp: stamp(timeS), frame_id: 'radar_1' },
  returns: Array.from(azimuthDeg, (angle, i) => ({
    range: rangeM[i],
    azimuth: azimuth * angle * RAD,
    elevation: 0,
    doppler_velocity: rangeRate * rangeRateMps[i],
    amplitude: 10,
  })),
});

/** foxglove.PointCloud as `boresight serve` packs it. */
export function pointCloud({ timeS, azimuthDeg, rangeRateMps, rangeM, rcsDbsm }) {
  const names = ['x', 'y', 'z', 'range_m', 'azimuth_rad', 'range_rate_mps', 'rcs_dbsm'];
  const data = new DataView(new ArrayBuffer(4 * names.length * azimuthDeg.length));
  azimuthDeg.forEach((angle, i) => {
    const azimuth = angle * RAD;
    const row = [
      rangeM[i] * Math.cos(azimuth),
      rangeM[i] * Math.sin(azimuth),
      0,
      rangeM[i],
      azimuth,
      rangeRateMps[i],
      rcsDbsm?.[i] ?? Number.NaN,
    ];
    row.forEach((value, column) => void data.setFloat32(4 * (i * names.length + column), value, true));
  });
  return {
    timestamp: stamp(timeS, 'nsec'),
    frame_id: 'radar_1',
    pose: { position: { x: 0, y: 0, z: 0 }, orientation: { x: 0, y: 0, z: 0, w: 1 } },
    point_stride: 4 * names.length,
    fields: names.map((name, i) => ({ name, offset: 4 * i, type: 7 })),
    data: Buffer.from(data.buffer).toString('base64'),
  };
}

/** nav_msgs/Odometry. */
export const odometry = (timeS, yawRateDegps, speedMps) => ({
  header: { stamp: stamp(timeS), frame_id: 'odom' },
  child_frame_id: 'base_link',
  twist: {
    twist: { linear: { x: speedMps, y: 0, z: 0 }, angular: { x: 0, y: 0, z: yawRateDegps * RAD } },
  },
});

/** Messages of scans and motion in order of time, as `{ topic, schemaName, timeS, message }`. */
export function messages({ drive: { motion }, frames }, form = 'ros', signs = undefined) {
  const scans = frames.map((frame) => ({
    timeS: frame.timeS,
    ...(form === 'ros'
      ? { topic: '/radar/scan', schemaName: 'radar_msgs/msg/RadarScan', message: radarScan(frame, signs) }
      : { topic: '/radar/1/detections', schemaName: 'foxglove.PointCloud', message: pointCloud(frame) }),
  }));
  const samples = Array.from(motion.timeS, (timeS, i) => {
    const [yawRateDegps, speedMps] = [motion.yawRateDegps[i], motion.speedMps[i]];
    return {
      timeS,
      ...(form === 'ros'
        ? { topic: '/odometry', schemaName: 'nav_msgs/msg/Odometry', message: odometry(timeS, yawRateDegps, speedMps) }
        : {
            topic: '/car/motion',
            schemaName: 'boresight.CarMotion',
            message: { timestamp: stamp(timeS, 'nsec'), yawRateDegps, speedMps },
          }),
    };
  });
  return [...scans, ...samples].sort((a, b) => a.timeS - b.timeS);
}
