// Runs the angle experiments with the shipped networks and puts figures, numbers and tables where the documents and the
// page have them. Records stay in target/experiments: only networks trained since are run again.
// `--binary FILE` takes a command line that is built already; `--trials N` runs at most so many trials a condition, which
// the tables say.
import { cpSync, existsSync, mkdirSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { root } from './lib/paths.mjs';
import { main, run } from './lib/run.mjs';
import { withTables } from './lib/tables.mjs';

/**
 * `kinds` and `waveform` say which networks take part, `drawn` names the numbers of the page and begins the names of the
 * figures' files.
 */
const EXPERIMENTS = [
  {
    name: 'aoa',
    experiment: 'aoa',
    kinds: ['aaetr', 'learned-pursuit'],
    settings: ['--trials', '4000', '--seed', '1'],
    drawn: { page: 'aoa', prefix: 'aoa-' },
  },
  {
    name: 'aoa-ula48',
    experiment: 'aoa',
    kinds: [],
    settings: [
      ...['--array', 'ula48', '--trials', '500', '--seed', '1'],
      ...['--methods', 'bartlett,iaa,iaa+refined,nomp,single-snapshot-music,maximum-likelihood'],
    ],
  },
  {
    name: 'doa',
    experiment: 'doa',
    kinds: ['counting', 'cnn3d', 'dnn'],
    waveform: '3dcnn-simulated',
    settings: ['--trials', '2100', '--seed', '0'],
    drawn: { page: 'doa', prefix: '' },
  },
  {
    name: 'doa-experiment',
    experiment: 'doa',
    kinds: ['counting', 'cnn3d', 'dnn'],
    waveform: '3dcnn-experiment',
    settings: ['--setup', 'experiment', '--trials', '2100', '--seed', '0'],
  },
];

const models = join(root, 'models');
const cards = readdirSync(models)
  .filter((file) => file.endsWith('.json'))
  .map((file) => ({
    ...JSON.parse(readFileSync(join(models, file), 'utf8')),
    onnx: join('models', file.replace(/json$/, 'onnx')),
  }));

/** Removes records of networks that are no longer those shipped. */
function forgetOld(folder, name) {
  for (const { name: network, sha256 } of cards) {
    const records = join(folder, `${name}-${network}.jsonl`);
    if (!existsSync(records)) continue;
    const [head] = readFileSync(records, 'utf8').split('\n', 1);
    if (JSON.parse(head).options.networks[0].sha256 !== sha256) rmSync(records);
  }
}

function argument(name) {
  const at = process.argv.indexOf(name);
  return at > 0 ? process.argv[at + 1] : undefined;
}

/** Settings with at most so many trials. */
function limited(settings, most) {
  return settings.map((value, i) => (settings[i - 1] === '--trials' && most < Number(value) ? String(most) : value));
}

await main(async () => {
  const binary = argument('--binary');
  const [command, ...before] = binary ? [binary] : ['cargo', 'run', '--profile', 'dist', '-p', 'boresight-cli', '--'];
  const most = Number(argument('--trials') ?? Number.POSITIVE_INFINITY);
  mkdirSync(join(root, 'docs', 'experiments'), { recursive: true });
  const tables = {};
  for (const { name, experiment, kinds, waveform, settings, drawn } of EXPERIMENTS) {
    const folder = join(root, 'target', 'experiments', name);
    forgetOld(folder, experiment);
    const networks = cards
      .filter(({ network, data }) => kinds.includes(network) && data.waveform === waveform)
      .flatMap(({ onnx }) => ['--model', onnx]);
    await run(command, [...before, 'evaluate', experiment, ...limited(settings, most), ...networks, '--out', folder]);
    tables[name] = readFileSync(join(folder, `${experiment}.md`), 'utf8');
    if (!drawn) continue;
    cpSync(join(folder, `${experiment}.brief.json`), join(root, 'docs', 'experiments', `${drawn.page}.json`));
    for (const file of readdirSync(folder).filter((entry) => entry.endsWith('.svg')))
      cpSync(join(folder, file), join(root, 'docs', 'images', drawn.prefix + file));
  }
  for (const name of ['aoa', 'doa']) {
    const document = join(root, 'docs', `experiments-${name}.md`);
    writeFileSync(document, withTables(readFileSync(document, 'utf8'), tables));
  }
});
