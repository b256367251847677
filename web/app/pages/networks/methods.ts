/** Methods as the experiments name them: a method or network, perhaps refined or smoothed. */
import { api } from '../../data.ts';
import { KIND_TITLES, MODELS } from '../../networks/models.ts';
import { methodStyle, type SeriesStyle } from '../../plots/theme.ts';

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

export function styleOf(name: string): SeriesStyle {
  const { base, variant } = partsOf(name);
  const kind = kindOf(name);
  const style = COUNTERS[base] ?? methodStyle(kind ?? base);
  if (kind && base.includes('large')) return { ...style, dash: [], marker: 'up', width: 2.4 };
  if (base.endsWith('-perturbed')) return { ...style, marker: 'square', dash: variant ? [8, 3, 2, 3] : [8, 3] };
  return variant ? { ...style, dash: [4, 3] } : style;
}
