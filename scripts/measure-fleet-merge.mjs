// Measures planning and merging of a large fleet: so many logs that are there, and records as a run would leave them. Prints the time and
// the most memory of `fleet plan` and `fleet merge`, and fails beyond 5 minutes or 1 GB. `--logs 100000`, `--vehicles 1000`, `--keep`. Logs and
// records are made up: the records are those of one simulated drive with other angles. Linux only, for the memory.
import { execFileSync, spawn } from 'node:child_process';
import { once } from 'node:events';
import {
  createReadStream,
  createWriteStream,
  mkdirSync,
  mkdtempSync,
  readFileSync,
  rmSync,
  statSync,
  writeFileSync,
} from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { createInterface } from 'node:readline';
import { parseArgs } from 'node:util';
import { root } from './lib/paths.mjs';
import { main, run } from './lib/run.mjs';

const MOST_S = 300;
const MOST_BYTES = 1e9;
const MEGABYTE = 1e6;
const LOOK_MS = 20;

const { values } = parseArgs({
  options: {
    logs: { type: 'string', default: '100000' },
    vehicles: { type: 'string', default: '1000' },
    keep: { type: 'boolean', default: false },
  },
});
const logs = Number(values.logs);
const vehicles = Number(values.vehicles);

/** Runs a command to its end: its seconds, its most memory in bytes, and what it printed. */
async function measured(command, args) {
  const started = performance.now();
  const child = spawn(command, args, { stdio: ['ignore', 'pipe', 'inherit'] });
  let most = 0;
  const look = setInterval(() => {
    try {
      const peak = /VmHWM:\s+(\d+) kB/.exec(readFileSync(`/proc/${child.pid}/status`, 'utf8'))?.[1];
      most = Math.max(most, 1024 * Number(peak ?? 0));
    } catch {
      // It has ended.
    }
  }, LOOK_MS);
  let text = '';
  child.stdout.setEncoding('utf8').on('data', (piece) => {
    text += piece;
  });
  const [code] = await once(child, 'close');
  clearInterval(look);
  if (code !== 0) throw new Error(`${args.slice(0, 2).join(' ')} ended with ${code}`);
  return { seconds: (performance.now() - started) / 1000, bytes: most, text };
}

/** Numbers between 0 and 1 that a seed decides (mulberry32). */
function draws(seed) {
  let state = seed;
  return () => {
    state = (state + 0x6d2b79f5) | 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 2 ** 32;
  };
}

/** A record of a job of the plan: that of the simulated drive with angles as if of another, by about what it states. */
function madeUp(pattern, job, draw) {
  const normal = () => Math.sqrt(-2 * Math.log(1 - draw())) * Math.cos(2 * Math.PI * draw());
  const radars = pattern.done.radars.map((radar) => {
    const off = normal() * radar.result.sigmaDeg;
    const equations = structuredClone(radar.equations);
    // The angle's own equation moved: what all unknowns have in common with it moves too.
    const turn = (off * Math.PI) / 180;
    const column = [0, 1, 2, 3, 4].map((at) => equations.information[at]);
    equations.right = equations.right.map((value, at) => value + column[at] * turn);
    return { ...radar, result: { ...radar.result, angleDeg: radar.result.angleDeg + off }, equations };
  });
  const { key, vehicle, drive, path } = job;
  return { key, vehicle, drive, timeS: job.timeS, path, done: { ...pattern.done, radars } };
}

await main(async () => {
  await run('cargo', ['build', '--quiet', '--release', '-p', 'boresight-cli']);
  const boresight = join(root, 'target', 'release', 'boresight');
  const top = mkdtempSync(join(tmpdir(), 'boresight-fleet-'));
  try {
    const drive = join(top, 'drive');
    execFileSync(boresight, ['simulate', 'drive', '--profile', 'radarscenes', '--seed', '1', '--out', drive]);
    const one = join(top, 'one.jsonl');
    execFileSync(boresight, ['fleet', 'plan', join(drive, 'data', 'sequence_1'), '--out', one]);
    const pattern = JSON.parse(execFileSync(boresight, ['fleet', 'run', one], { encoding: 'utf8' }));

    const list = [];
    for (let at = 0; at < logs; at++) {
      const vehicle = `car${at % vehicles}`;
      const folder = join(top, 'logs', vehicle);
      if (at < vehicles) mkdirSync(folder, { recursive: true });
      const path = join(folder, `d${Math.floor(at / vehicles)}.csv`);
      writeFileSync(path, `made up,${at}\n`);
      list.push(JSON.stringify({ path, timeS: 1.7e9 + 86_400 * Math.floor(at / vehicles) }));
    }
    const listed = join(top, 'list.jsonl');
    writeFileSync(listed, `${list.join('\n')}\n`);
    const plan = join(top, 'jobs.jsonl');
    const planned = await measured(boresight, ['fleet', 'plan', '--list', listed, '--out', plan]);

    const records = join(top, 'records.jsonl');
    const out = createWriteStream(records);
    const draw = draws(1);
    for await (const line of createInterface({ input: createReadStream(plan) })) {
      if (!out.write(`${JSON.stringify(madeUp(pattern, JSON.parse(line), draw))}\n`)) await once(out, 'drain');
    }
    out.end();
    await once(out, 'close');
    const results = join(top, 'results');
    const merged = await measured(boresight, ['fleet', 'merge', records, '--plan', plan, '--out', results]);

    const size = (path) => `${(statSync(path).size / MEGABYTE).toFixed(1)} MB`;
    console.log(`${logs} logs of ${vehicles} vehicles, made up; records ${size(records)}`);
    for (const [name, { seconds, bytes }] of Object.entries({ plan: planned, merge: merged }))
      console.log(`${name.padEnd(6)} ${seconds.toFixed(1)} s, ${(bytes / MEGABYTE).toFixed(0)} MB`);
    for (const name of ['fleet.json', 'drives.parquet', 'radars.parquet', 'report.html'])
      console.log(`  ${name} ${size(join(results, name))}`);
    console.log(merged.text.split('\n').slice(0, 6).join('\n'));
    const seconds = planned.seconds + merged.seconds;
    const bytes = Math.max(planned.bytes, merged.bytes);
    if (seconds > MOST_S || bytes > MOST_BYTES) throw new Error(`more than ${MOST_S} s or ${MOST_BYTES / MEGABYTE} MB`);
  } finally {
    if (values.keep) console.log(top);
    else rmSync(top, { recursive: true, force: true });
  }
});
