// Runs the angle experiments with the shipped networks and puts figures, numbers and tables where the documents and the
// page have them. Records stay in target/experiments, by the trials asked for: only networks trained since are run again.
// `npm run experiments -- aoa images` runs these alone. `--binary FILE` takes a command line that is built already;
// `--trials N` runs at most so many trials a condition, which the tables say.
import { cpSync, existsSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { parseArgs } from 'node:util';
import { root } from '../../scripts/lib/paths.mjs';
import { main, run, runKeeping } from '../../scripts/lib/run.mjs';
import { cardsOf, cards as shippedCards } from './cards.mjs';
import { endToEndTables } from './end-to-end.mjs';
import { withTables } from './tables.mjs';

/** Networks that answer a snapshot of the array lrr48. */
const SNAPSHOTS = { kinds: ['aaetr', 'learned-pursuit'] };
/** Those of them whose training ended on elements where they should be. */
const EXACT = { ...SNAPSHOTS, positionError: 0 };
/** Networks that answer a region of interest. */
const REGIONS = { kinds: ['counting', 'cnn3d', 'dnn'], waveform: '3dcnn-simulated' };

/**
 * `networks` says which take part, `document` which page of research/results has the tables, `shown` that the demo shows the numbers.
 * `figures` begins the names that figures have in research/results/figures; without it they stay. `printed` says that the
 * tables are what the command prints, without records.
 */
const EXPERIMENTS = [
  {
    name: 'aoa',
    experiment: 'aoa',
    document: 'aoa',
    networks: { kinds: [...SNAPSHOTS.kinds, 'unrolled-iaa'] },
    settings: ['--trials', '4000', '--seed', '1'],
    figures: 'aoa-',
    shown: true,
  },
  {
    name: 'aoa-ula48',
    experiment: 'aoa',
    document: 'aoa',
    settings: [
      ...['--array', 'ula48', '--trials', '500', '--seed', '1'],
      ...['--methods', 'bartlett,iaa,iaa+refined,nomp,single-snapshot-music,maximum-likelihood'],
    ],
  },
  {
    name: 'aoa-atomic-norm',
    experiment: 'aoa',
    document: 'aoa',
    settings: ['--trials', '500', '--seed', '1', '--methods', 'iaa,iaa+refined,nomp,atomic-norm'],
  },
  {
    name: 'aoa-plain-iaa',
    experiment: 'aoa',
    document: 'aoa',
    settings: ['--trials', '400', '--seed', '1', '--methods', 'plain-iaa,iaa'],
  },
  {
    name: 'aoa-outside',
    experiment: 'aoa',
    document: 'aoa',
    networks: SNAPSHOTS,
    settings: [
      ...['--trials', '500', '--seed', '1', '--targets', '10,15,20', '--snr', '5,15', '--spread', '25'],
      ...['--methods', 'plain-iaa,iaa,iaa+refined,nomp'],
    ],
  },
  {
    name: 'arrays',
    experiment: 'arrays',
    document: 'arrays',
    networks: { kinds: ['aaetr'], array: 'any' },
    settings: ['--trials', '500', '--seed', '0'],
  },
  {
    name: 'hard',
    experiment: 'hard',
    document: 'hard',
    networks: { kinds: ['aaetr'] },
    settings: ['--trials', '1000', '--seed', '0'],
    figures: '',
  },
  {
    name: 'hard-times',
    experiment: 'aoa',
    document: 'hard',
    networks: { kinds: ['aaetr'] },
    settings: ['--times', '--methods', 'iaa,plain-iaa,plain-iaa-half-degree,iaa+refined,nomp'],
    printed: true,
  },
  {
    name: 'low-snr',
    experiment: 'low-snr',
    document: 'low-snr',
    networks: { kinds: ['covariance-cnn', 'deep-music'] },
    settings: ['--trials', '500', '--seed', '0'],
  },
  {
    name: 'doa',
    experiment: 'doa',
    document: 'doa',
    networks: REGIONS,
    settings: ['--trials', '2100', '--seed', '0'],
    figures: '',
    shown: true,
  },
  {
    name: 'doa-power',
    experiment: 'doa',
    document: 'doa',
    networks: { names: ['cnn3d-2', 'cnn3d-paper-2', 'dnn-large-2', 'dnn-small-2'] },
    settings: ['--axis', 'power-difference', '--trials', '420', '--seed', '0'],
  },
  ...[[], ['--centre', '35']].map((centre) => ({
    name: ['doa-end-to-end', ...centre.slice(1)].join('-'),
    experiment: 'doa',
    document: 'doa',
    networks: { names: ['counting', 'cnn3d-1', 'cnn3d-2', 'cnn3d-paper-2', 'dnn-small-1', 'dnn-small-2'] },
    settings: ['--regions', 'end-to-end', '--trials', '2100', '--seed', '0', ...centre],
  })),
  {
    name: 'doa-experiment',
    experiment: 'doa',
    document: 'doa',
    networks: { ...REGIONS, waveform: '3dcnn-experiment' },
    settings: ['--setup', 'experiment', '--trials', '2100', '--seed', '0'],
  },
  ...[
    ['straddling', 1000, EXACT],
    ['near-field', 500, EXACT],
    ['imperfections', 500, SNAPSHOTS],
  ].map(([name, trials, networks]) => ({
    name,
    experiment: name,
    document: name,
    networks,
    settings: ['--trials', String(trials), '--seed', '0'],
    figures: '',
  })),
  {
    name: 'resolution',
    experiment: 'resolution',
    document: 'resolution',
    settings: ['--trials', '160', '--seed', '0'],
    figures: '',
  },
  {
    name: 'images',
    experiment: 'images',
    document: 'images',
    networks: EXACT,
    settings: ['--streets', '4', '--seed', '0'],
  },
];

/** Experiments whose brief records make the tables of `doa-flow` together. */
const FLOW = ['doa', 'doa-end-to-end', 'doa-end-to-end-35'];

const cards = shippedCards();

/** Removes records of networks, or of regions they counted, that are no longer those shipped. */
function forgetOld(folder, name) {
  const current = new Map(cards.map((card) => [card.name, card.sha256]));
  for (const file of existsSync(folder) ? readdirSync(folder) : []) {
    if (!file.startsWith(name) || !file.endsWith('.jsonl')) continue;
    const [head] = readFileSync(join(folder, file), 'utf8').split('\n', 1);
    const { networks = [], endToEnd } = JSON.parse(head).options;
    const used = [...networks, endToEnd?.counting].filter(Boolean);
    if (used.some((network) => current.get(network.name) !== network.sha256)) rmSync(join(folder, file));
  }
}

/** What a command prints. */
async function outputOf(command, args) {
  let printed = '';
  const keep = (piece, stream) => {
    if (stream === 'stdout') printed += piece;
  };
  const { ok, text } = await runKeeping(command, args, {}, keep);
  if (!ok) throw new Error(text);
  return printed;
}

/** Settings with at most so many trials. */
function limited(settings, most) {
  return settings.map((value, i) => (settings[i - 1] === '--trials' && most < Number(value) ? String(most) : value));
}

/** Tables of whole frames next to given regions, once there are records of all. */
function flowTables(folder) {
  const records = FLOW.map((name) => join(folder(name), 'doa.brief.json'));
  if (!records.every((file) => existsSync(file))) return {};
  return { 'doa-flow': endToEndTables(...records.map((file) => JSON.parse(readFileSync(file, 'utf8')))) };
}

await main(async () => {
  const { values, positionals } = parseArgs({
    allowPositionals: true,
    options: { binary: { type: 'string' }, trials: { type: 'string' } },
  });
  const unknown = positionals.find((wanted) => EXPERIMENTS.every(({ name }) => name !== wanted));
  if (unknown) throw new Error(`experiment '${unknown}': expected ${EXPERIMENTS.map(({ name }) => name).join(', ')}`);
  const wanted = EXPERIMENTS.filter(({ name }) => !positionals.length || positionals.includes(name));
  const [command, ...before] = values.binary
    ? [values.binary]
    : ['cargo', 'run', '--profile', 'dist', '-p', 'boresight-experiments', '--'];
  const most = Number(values.trials ?? Number.POSITIVE_INFINITY);
  const folderOf = (name) => join(root, 'target', 'experiments', values.trials ? `${name}-${values.trials}` : name);
  const results = join(root, 'research', 'results');
  for (const { name, experiment, document, networks, settings, figures, shown, printed } of wanted) {
    const folder = folderOf(name);
    const options = [...limited(settings, most), ...cardsOf(networks, cards).flatMap(({ onnx }) => ['--model', onnx])];
    const page = join(results, `${document}.md`);
    const tables = {};
    if (printed) {
      tables[name] = await outputOf(command, [...before, experiment, ...options]);
    } else {
      forgetOld(folder, experiment);
      await run(command, [...before, experiment, ...options, '--out', folder]);
      tables[name] = readFileSync(join(folder, `${experiment}.md`), 'utf8');
    }
    if (FLOW.includes(name)) Object.assign(tables, flowTables(folderOf));
    writeFileSync(page, withTables(readFileSync(page, 'utf8'), tables));
    if (shown) cpSync(join(folder, `${experiment}.brief.json`), join(results, `${experiment}.json`));
    if (figures === undefined) continue;
    for (const file of readdirSync(folder).filter((entry) => entry.endsWith('.svg')))
      cpSync(join(folder, file), join(results, 'figures', figures + file));
  }
});
