/** Methods as the experiments name them: a method or network, perhaps refined or smoothed. */

import { methodStyle, type SeriesStyle } from '../../../plots/theme.ts';
import { api } from '../../data.ts';
import { KIND_TITLES, MODELS, targetsOf } from '../../networks/models.ts';

const KINDS = Object.keys(KIND_TITLES) as (keyof typeof KIND_TITLES)[];

interface Parts {
  base: string;
  variant: string;
}

function partsOf(name: string): Parts {
  const [base = '', ...variant] = name.split(/\s*[+,]\s*/);
  return { base: base.toLowerCase(), variant: variant.join(', ') };
}

/** The kind of network a name stands for, or undefined for a classical method. */
export function kindOf(name: string): keyof typeof KIND_TITLES | undefined {
  const { base } = partsOf(name);
  return MODELS.find((model) => model.name === base)?.card.network ?? KINDS.find((kind) => base.startsWith(kind));
}

export function titleOf(name: string): string {
  const { base, variant } = partsOf(name);
  const kind = kindOf(name);
  const model = MODELS.find((one) => one.name === base);
  const title =
    model?.title ??
    (kind
      ? [KIND_TITLES[kind], ...base.slice(kind.length).split('-').filter(Boolean)].join(' ')
      : (api.methods().find((info) => info.name === base)?.title ?? name.split(/[+,]/)[0]));
  return [title, variant].filter(Boolean).join(', ');
}

const COUNTERS: Record<string, SeriesStyle> = {
  aic: { color: methodStyle('bartlett').color, marker: 'circle' },
  mdl: { color: methodStyle('capon').color, marker: 'square' },
};

/** What tells networks of one kind apart: those of the smallest first, which keep the style of their kind. */
const SIBLINGS: readonly Pick<SeriesStyle, 'dash' | 'marker'>[] = [
  {},
  { dash: [8, 3], marker: 'square' },
  { dash: [2, 2], marker: 'circle' },
  { dash: [10, 2, 2, 2], marker: 'cross' },
];

export function styleOf(name: string): SeriesStyle {
  const { base, variant } = partsOf(name);
  const kind = kindOf(name);
  const style = COUNTERS[base] ?? methodStyle(kind ?? base);
  const own = MODELS.find((model) => model.name === base);
  const siblings = own
    ? MODELS.filter(({ card }) => card.network === own.card.network && targetsOf(card) === targetsOf(own.card))
    : [];
  const sibling =
    SIBLINGS[
      Math.max(
        siblings.findIndex(({ name }) => name === base),
        0,
      ) % SIBLINGS.length
    ];
  return { ...style, ...sibling, ...(variant ? { dash: [4, 3] } : {}) };
}
