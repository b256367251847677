// Runs the angle experiments with the shipped networks and puts figures and numbers where the documents and the page
// have them. Records stay in target/experiments: only networks trained since are run again.
// `--binary FILE` takes a command line that is built already.
import { cpSync, existsSync, mkdirSync, readdirSync, readFileSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { root } from './lib/paths.mjs';
import { main, run } from './lib/run.mjs';

const EXPERIMENTS = [
  { name: 'aoa', kinds: ['aaetr', 'learned-pursuit'], settings: ['--trials', '1000', '--seed', '1'], prefix: 'aoa-' },
  { name: 'doa', kinds: ['counting', 'cnn3d', 'dnn'], settings: ['--trials', '2100', '--seed', '0'], prefix: '' },
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

await main(async () => {
  const at = process.argv.indexOf('--binary');
  const [command, ...before] =
    at > 0 ? [process.argv[at + 1]] : ['cargo', 'run', '--profile', 'dist', '-p', 'boresight-cli', '--'];
  mkdirSync(join(root, 'docs', 'experiments'), { recursive: true });
  for (const { name, kinds, settings, prefix } of EXPERIMENTS) {
    const folder = join(root, 'target', 'experiments', name);
    forgetOld(folder, name);
    const networks = cards.filter(({ network }) => kinds.includes(network)).flatMap(({ onnx }) => ['--model', onnx]);
    await run(command, [...before, 'evaluate', name, ...settings, ...networks, '--out', folder]);
    cpSync(join(folder, `${name}.brief.json`), join(root, 'docs', 'experiments', `${name}.json`));
    for (const file of readdirSync(folder).filter((entry) => entry.endsWith('.svg')))
      cpSync(join(folder, file), join(root, 'docs', 'images', prefix + file));
  }
});
