/** A drive as the command line writes it to tables, to compare with what viewers get. */
import { execFile } from 'node:child_process';
import { mkdtemp, readFile, rm } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { promisify } from 'node:util';
import Papa from 'papaparse';
import { commandLine } from '../../../scripts/lib/programs.mjs';

const run = promisify(execFile);

/** What the command line prints. */
export const boresight = async (...args) =>
  (await run(await commandLine(), args.map(String), { maxBuffer: 2 ** 26 })).stdout;

/** Runs work in a folder that is gone afterwards. */
export async function inFolder(work) {
  const folder = await mkdtemp(join(tmpdir(), 'boresight-viewers-'));
  try {
    return await work(folder);
  } finally {
    await rm(folder, { recursive: true, force: true });
  }
}

const rows = async (folder, name) =>
  Papa.parse(await readFile(join(folder, name), 'utf8'), { header: true, skipEmptyLines: true }).data;
const number = (text) => (text === '' ? Number.NaN : Number(text));

/** Detections of each scan that has any, in order, and samples of the motion, as `boresight log --export` writes them. */
export const exported = (log) =>
  inFolder(async (folder) => {
    await boresight('log', log, '--export', folder);
    const scans = new Map();
    for (const row of await rows(folder, 'detections.csv')) {
      const key = `${row.sensor} ${row.time_s}`;
      if (!scans.has(key)) scans.set(key, []);
      const numbers = [row.range_m, row.azimuth_rad, row.range_rate_mps, row.rcs_dbsm];
      scans.get(key).push(numbers.map((text) => Math.fround(number(text))));
    }
    const motion = (await rows(folder, 'motion.csv')).map((row) =>
      Object.fromEntries(Object.entries(row).map(([name, text]) => [name, number(text)])),
    );
    return { scans: [...scans.values()], motion };
  });

/** The points of a `foxglove.PointCloud`, as `exported` has them; x and y are checked against range and azimuth. */
export function points(cloud) {
  const bytes = Buffer.from(cloud.data, 'base64');
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.length);
  const float = (at, name) => {
    const { offset, type } = cloud.fields.find((field) => field.name === name);
    if (type !== 7) throw new Error(`${name} is of type ${type}`);
    return view.getFloat32(at + offset, true);
  };
  const all = [];
  for (let at = 0; at < bytes.length; at += cloud.point_stride) {
    const [x, y, range, azimuth] = ['x', 'y', 'range_m', 'azimuth_rad'].map((name) => float(at, name));
    if (x !== Math.fround(range * Math.cos(azimuth)) || y !== Math.fround(range * Math.sin(azimuth))) {
      // Transcendental functions differ in their last digits.
      if (!(Math.hypot(x - range * Math.cos(azimuth), y - range * Math.sin(azimuth)) < 1e-6 * range))
        throw new Error(`${x}, ${y} for ${range}, ${azimuth}`);
    }
    all.push([range, azimuth, float(at, 'range_rate_mps'), float(at, 'rcs_dbsm')]);
  }
  return all;
}
