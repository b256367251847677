// A drive as nuScenes lays it out: a cloud a scan, and the tables beside. A radar at 3.5 m, turned by 2 degrees, past
// standing things; the car swings left and right at 10 m/s.

const LOG = 'n015-2018-07-24-11-22-45+0800';
const FIRST_US = 1_532_402_927_000_000;
const TURNED = (2 * Math.PI) / 180;

const rotation = (yaw) => [Math.cos(yaw / 2), 0, 0, Math.sin(yaw / 2)];
const json = (name, rows) => ({ name: `v1.0-mini/${name}.json`, bytes: Buffer.from(JSON.stringify(rows)) });

/** `sign` -1 for azimuths that are positive to the right. */
export function clouds({ seconds = 30, sign = 1 } = {}) {
  const files = [];
  const [data, poses] = [[], []];
  let seed = 1;
  const noise = () => {
    seed = (seed * 48271) % 2147483647;
    return seed / 2147483647 - 0.5;
  };
  let [x, y, heading, last] = [0, 0, 0, 0];
  for (let scan = 0; scan * 0.075 < seconds; scan++) {
    const time = scan * 0.075;
    const yawRate = 0.2 * Math.sin(time / 2);
    // The path in steps of a millisecond.
    for (; last < time; last += 0.001) {
      x += 0.01 * Math.cos(heading);
      y += 0.01 * Math.sin(heading);
      heading += 0.001 * 0.2 * Math.sin(last / 2);
    }
    const stamp = FIRST_US + Math.round(1e6 * time);
    const rows = [];
    for (let k = 0; k < 30; k++) {
      const azimuth = ((-55 + 3.8 * k) * Math.PI) / 180;
      const direction = azimuth + TURNED;
      const rate = -(10 * Math.cos(direction) + yawRate * 3.5 * Math.sin(direction)) + 0.1 * noise();
      const [cos, sin] = [Math.cos(azimuth), sign * Math.sin(azimuth)];
      const range = 10 + k;
      const numbers = [range * cos, range * sin, 0, rate / cos, 0, 5];
      rows.push([...numbers.map((number) => number.toFixed(6)), 3, 0, 1].join(' '));
    }
    const head = [
      'VERSION 0.7',
      'FIELDS x y z vx vy rcs ambig_state invalid_state dyn_prop',
      'SIZE 4 4 4 4 4 4 1 1 1',
      'TYPE F F F F F F I I I',
      `WIDTH ${rows.length}`,
      `POINTS ${rows.length}`,
      'DATA ascii',
    ];
    const name = `sweeps/RADAR_FRONT/${LOG}__RADAR_FRONT__${stamp}.pcd`;
    files.push({ name, bytes: Buffer.from([...head, ...rows, ''].join('\n')) });
    const token = `p${scan}`;
    poses.push({ token, timestamp: stamp, translation: [x, y, 0], rotation: rotation(heading) });
    data.push({ ego_pose_token: token, calibrated_sensor_token: 'c', timestamp: stamp, filename: name });
  }
  return [
    ...files,
    json('sample_data', data),
    json('ego_pose', poses),
    json('calibrated_sensor', [
      { token: 'c', sensor_token: 's', translation: [3.5, 0, 0.5], rotation: rotation(TURNED) },
    ]),
    json('sensor', [{ token: 's', channel: 'RADAR_FRONT', modality: 'radar' }]),
  ];
}
