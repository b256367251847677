// Tables of networks from the cards of all networks, for the pages of results.
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { root } from '../../scripts/lib/paths.mjs';
import { withTables } from './tables.mjs';

/** All cards, each with the path of its network. */
export function cards() {
  const paths = ['models', 'research/models'].flatMap((folder) =>
    readdirSync(join(root, folder)).map((file) => join(folder, file)),
  );
  const found = paths.filter((path) => path.endsWith('.json'));
  return found
    .map((path) => ({ ...JSON.parse(readFileSync(join(root, path), 'utf8')), onnx: path.replace(/json$/, 'onnx') }))
    .sort((a, b) => a.name.localeCompare(b.name));
}

const grouped = (number) => number.toLocaleString('en-US');

/** What a run of training saw: samples, and of what. */
function seen({ samplesSeen, data }) {
  const what = data.array === 'any' ? 'random arrays' : (data.array ?? data.waveform);
  const displaced = data.positionError > 0 ? `, displaced by ${data.positionError} half wavelengths` : '';
  const close = data.closePairs ? `, close pairs in ${100 * data.closePairs} %` : '';
  const [low, high] = data.snrDb;
  const lower = data.secondStageLowestSnrDb ?? low;
  const later = lower < low ? `, second half ${lower} to ${high} dB` : '';
  const weaker = data.secondStageWeakerDb ? `, second target up to ${data.secondStageWeakerDb} dB weaker` : '';
  return `${grouped(samplesSeen)} of ${what}${displaced}${close}, ${low} to ${high} dB${later}${weaker}`;
}

/** Hours of training, and of what. */
function hoursOf(legs) {
  const byHardware = new Map();
  for (const { hours, hardware } of legs) {
    const gpu = /NVIDIA (\S+)/.exec(hardware)?.[1];
    const name = gpu ?? 'CPU thread';
    byHardware.set(name, (byHardware.get(name) ?? 0) + hours);
  }
  return [...byHardware].map(([name, hours]) => `${hours.toFixed(hours < 1 ? 2 : 1)} ${name}`).join(', ');
}

/** A table, as a command prints it, of networks: parameters, training and its hours. */
export function networkTable(networks) {
  const rows = networks.map(({ name, title, parameters, legs }) => {
    const runs = legs.map(seen).join('; then ');
    return `| ${name} | ${title} | ${grouped(parameters)} | ${runs} | ${hoursOf(legs)} |`;
  });
  const heads = '| network | form | parameters | training examples by run, in order | hours |';
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
    const path = `research/results/${name}.md`;
    const printed = { [`${name}-networks`]: networkTable(cardsOf(networks)) };
    return [path, withTables(readFileSync(join(root, path), 'utf8'), printed)];
  });
}
