/** A drive whose tables have columns that are not Boresight's. */
import { gzipSync } from 'node:zlib';

/** What a radar 3.5 m ahead, turned by 2 degrees, sees of standing things while the car swings left and right. */
export function* frames() {
  for (let i = 0; i < 300; i++) {
    const t = i * 0.075;
    const yawRate = 0.2 * Math.sin(t / 2);
    const speed = 10 + 3 * Math.sin(t / 5);
    const seen = Array.from({ length: 16 }, (_, k) => {
      const azimuth = ((-55 + 7 * k) * Math.PI) / 180;
      const direction = azimuth + (2 * Math.PI) / 180;
      const rate = -(speed * Math.cos(direction) + yawRate * 3.5 * Math.sin(direction));
      return { azimuth, rate, range: 10 + k };
    });
    yield { t, yawRate, speed, seen };
  }
}

export const file = (name, lines) => ({ name, bytes: Buffer.from(`${lines.join('\n')}\n`) });

/** Microseconds, radians positive to the right, closing speeds in km/h, named radars; the motion apart. */
export function foreign() {
  const radar = ['timestamp;radarName;Azimuth right [rad];closing_radial_speed [km/h];Distance (m);quality'];
  const car = ['Timestamp_us;YawRate;v_ego'];
  const comma = (value) => value.toFixed(6).replace('.', ',');
  for (const { t, yawRate, speed, seen } of frames()) {
    const us = 1.6e15 + Math.round(t * 1e6);
    car.push(`${us};${comma(yawRate)};${comma(speed)}`);
    for (const { azimuth, rate, range } of seen)
      radar.push(`${us};front;${comma(-azimuth)};${comma(-rate * 3.6)};${comma(range)};7`);
  }
  radar.push('1600000023000000;front;n/a;1,5;3,0;7', '1600000023000000;front;;1,5;3,0;7');
  return [file('radar log.csv', radar), { name: 'car.csv.gz', bytes: gzipSync(file('', car).bytes) }];
}
