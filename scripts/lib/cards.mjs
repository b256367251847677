// Tables of networks from the cards in models/, for the documents.
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { root } from './paths.mjs';
import { withTables } from './tables.mjs';

const folder = join(root, 'models');

/** All cards, each with the path of its network. */
export function cards() {
  const files = readdirSync(folder).filter((file) => file.endsWith('.json'));
  return files.map((file) => ({
    ...JSON.parse(readFileSync(join(folder, file), 'utf8')),
    onnx: join('models', file.replace(/json$/, 'onnx')),
  }));
}

const grouped = (number) => number.toLocaleString('en-US');

/** What a run of training saw: samples, and of what. */
function seen({ samplesSeen, data }) {
  const what = data.array === 'any' ? 'random arrays' : (data.array ?? data.waveform);
  const displaced = data.positionError > 0 ? `, displaced by ${data.positionError} half wavelengths` : '';
  const [low, high] = data.snrDb;
  const lower = data.secondStageLowestSnrDb ?? low;
  const later = lower < low ? `, second half ${lower} to ${high} dB` : '';
  const weaker = data.secondStageWeakerDb ? `, second target up to ${data.secondStageWeakerDb} dB weaker` : '';
  return `${grouped(samplesSeen)} of ${what}${displaced}, ${low} to ${high} dB${later}${weaker}`;
}

/** A table, as a command prints it, of networks: parameters, training and its hours. */
export function networkTable(networks) {
  const rows = networks.map(({ name, title, parameters, legs, hours }) => {
    const runs = legs.map(seen).join('; then ');
    return `| ${name} | ${title} | ${grouped(parameters)} | ${runs} | ${hours.toFixed(1)} |`;
  });
  const heads = '| network | form | parameters | training examples by run, in order | hours of a CPU thread |';
  return ['Networks, from their cards', '', heads, '|---|---|---|---|---|', ...rows].join('\n');
}

/** Cards of some networks: by name, or by kind and what their data are. */
export function cardsOf({ names, kinds = [], ...data } = {}, all = cards()) {
  const fits = (card) => kinds.includes(card.network) && Object.keys(data).every((key) => card.data[key] === data[key]);
  return all.filter((card) => names?.includes(card.name) ?? fits(card));
}

/** The networks of each place `NAME-networks` of a document. */
const PLACES = {
  aoa: { kinds: ['aaetr', 'learned-pursuit', 'unrolled-iaa'] },
  arrays: { kinds: ['aaetr'], array: 'any' },
  doa: { kinds: ['counting', 'cnn3d', 'dnn'], waveform: '3dcnn-simulated' },
};

/** Documents with tables of networks, each a path and its text with the tables of the cards. */
export function networkDocuments() {
  return Object.entries(PLACES).map(([name, networks]) => {
    const path = `docs/experiments-${name}.md`;
    const printed = { [`${name}-networks`]: networkTable(cardsOf(networks)) };
    return [path, withTables(readFileSync(join(root, path), 'utf8'), printed)];
  });
}
