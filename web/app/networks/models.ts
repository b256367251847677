/**
 * The networks this site has: their cards, which are part of the page, and the addresses of their files, which load on
 * demand.
 */
import type { ArrayGeometry, ModelCard, NetworkKind } from 'boresight';

/** A run of training; the next began with its weights. */
export interface Leg {
  title?: string;
  data?: Record<string, unknown>;
  training?: Record<string, unknown>;
  samplesSeen?: number;
  hours?: number;
  hardware?: string;
}

/** Mean F1 over the conditions of a card on the way of a training, or of another one beside it. */
export interface LearningCurve {
  title: string;
  points: readonly { samples: number; hours: number; f1: number }[];
}

/** A card with what ours say beside what every card must. */
export type Card = ModelCard & {
  /** What the network is, in words. */
  architecture?: string;
  /** How it and its training differ from the publication. */
  differences?: string;
  /** Data that it was not trained for, and that it fails on. */
  limits?: string;
  model?: Record<string, unknown>;
  data?: Record<string, unknown>;
  loss?: Record<string, unknown>;
  /** Every run of training, first to last. */
  legs?: readonly Leg[];
  samplesSeen?: number;
  hours?: number;
  software?: string;
  metricsExamples?: number;
  /** Of the run that gave the network, then of others. */
  learning?: readonly LearningCurve[];
  onnx?: { opset?: number; weights?: string; parity?: number };
  bytes?: number;
};

export interface Model {
  /** Name of its files, and in links. */
  name: string;
  title: string;
  card: Card;
  /** Whether the card came with it; else it was told from the file alone. */
  hasCard: boolean;
  /** Where its files are in the repository, with a slash at the end; absent for a user's own, as the addresses are. */
  folder?: string;
  address?: string;
  cardAddress?: string;
}

const folderOf = (path: string): string => path.replace(/^(\.\.\/)*/, '').replace(/[^/]*$/, '');
const stem = (path: string): string => path.replace(/^.*\//, '').replace(/\.\w+$/, '');

// Those of comparisons are in a folder of their own, which a checkout of the product alone lacks.
const cards = import.meta.glob<Card>(['../../../models/*.json', '../../../research/models/*.json'], {
  eager: true,
  import: 'default',
});
const cardAddresses = import.meta.glob<string>(['../../../models/*.json', '../../../research/models/*.json'], {
  eager: true,
  query: '?url',
  import: 'default',
});
const addresses = import.meta.glob<string>(['../../../models/*.onnx', '../../../research/models/*.onnx'], {
  eager: true,
  query: '?url',
  import: 'default',
});

/** What one example of a network is of. */
export type Sight = 'snapshot' | 'covariance' | 'region';

const KINDS: readonly NetworkKind[] = [
  ...(['aaetr', 'learned-pursuit', 'unrolled-iaa', 'covariance-cnn', 'deep-music'] as const),
  ...(['counting', 'dnn', 'cnn3d'] as const),
];
export const KIND_TITLES: Record<NetworkKind, string> = {
  aaetr: 'AAETR',
  'learned-pursuit': 'Learned pursuit',
  'unrolled-iaa': 'UAA',
  'covariance-cnn': 'Covariance CNN',
  'deep-music': 'DeepMUSIC',
  counting: 'Counting network',
  dnn: 'DNN',
  cnn3d: '3D-CNN',
};

/** How many targets a classifier of directions is for; null where the network finds that out. */
export function targetsOf({ network, targets: stated, data }: Card): number | null {
  const targets = typeof stated === 'number' ? [stated, stated] : data?.targets;
  return (network === 'dnn' || network === 'cnn3d') && Array.isArray(targets) && targets[0] === targets[1]
    ? Number(targets[1])
    : null;
}

function titleOf(card: Card): string {
  if (card.title) return card.title;
  const targets = targetsOf(card);
  return [KIND_TITLES[card.network], card.form, targets && (targets === 1 ? 'one target' : `${targets} targets`)]
    .filter(Boolean)
    .join(', ');
}

const shipped = Object.entries(cards)
  .flatMap(([path, card]): Model[] => {
    const address = addresses[path.replace(/json$/, 'onnx')];
    const cardAddress = cardAddresses[path];
    return address && cardAddress && KINDS.includes(card.network)
      ? [{ name: stem(path), folder: folderOf(path), title: titleOf(card), card, hasCard: true, address, cardAddress }]
      : [];
  })
  .sort(
    (a, b) =>
      KINDS.indexOf(a.card.network) - KINDS.indexOf(b.card.network) ||
      (a.card.parameters ?? 0) - (b.card.parameters ?? 0) ||
      a.name.localeCompare(b.name),
  );

/** Titles of two networks are never the same: their names then tell which is which. */
export const MODELS: readonly Model[] = shipped.map((model) =>
  shipped.some(({ name, title }) => name !== model.name && title === model.title)
    ? { ...model, title: `${model.title} (${model.name})` }
    : model,
);

/** Whether it sees one snapshot of many targets, the covariance of many snapshots, or a region of interest. */
export function sightOf({ network }: Card): Sight {
  switch (network) {
    case 'aaetr':
    case 'learned-pursuit':
    case 'unrolled-iaa':
      return 'snapshot';
    case 'covariance-cnn':
    case 'deep-music':
      return 'covariance';
    default:
      return 'region';
  }
}

/** Whether it was trained on elements with errors, as those of a board that is not calibrated. */
export const trainedOnBoards = ({ data }: Card): boolean => Number(data?.channelDb) > 0 || Number(data?.channelDeg) > 0;

/** Virtual elements the network's input has room for; null where any number goes. */
export function elementsOf(card: Card): number | null {
  const [, second, third] = card.inputs[0]?.axes ?? [];
  if (sightOf(card) === 'snapshot') return typeof second === 'number' ? second : null;
  if (sightOf(card) === 'covariance') return Number(third);
  if (card.network === 'cnn3d') return Number(third);
  // M (M - 1) numbers of a Hermitian matrix.
  return Math.round((1 + Math.sqrt(1 + 4 * Number(second))) / 2);
}

/** The array in words. */
export function arrayOf(card: Card): string {
  const elements = elementsOf(card);
  if (elements === null) {
    const [fewest, most] = Array.isArray(card.data?.elements) ? card.data.elements : [];
    return fewest === undefined ? 'any array' : `any array of ${fewest} to ${most} elements`;
  }
  return typeof card.data?.array === 'string' ? card.data.array : `${elements} elements half a wavelength apart`;
}

export type Geometry = Pick<ArrayGeometry, 'positions' | 'uniform' | 'aperture'>;

/** Why a network cannot work on an array, or null. */
export function arrayProblem(card: Card, { positions, uniform, aperture }: Geometry): string | null {
  const elements = elementsOf(card);
  if (elements === null) return null;
  const evenly = uniform && Math.abs(aperture - (elements - 1)) < 1e-6;
  if (positions.length !== elements || (sightOf(card) !== 'snapshot' && !evenly)) {
    return `is for ${arrayOf(card)}${typeof card.data?.array === 'string' ? ` (${elements} elements)` : ''}`;
  }
  return null;
}
