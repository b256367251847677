/** The signs on the images, once for all of them. */

import type { LegendItem } from '../../../elements/base/drawing.ts';
import { Swatch } from '../../ui/swatch.tsx';
import { TRUTH_COLOR } from './layers.ts';
import { birdseyeState } from './state.ts';

const both = (color: string) => ({ light: color, dark: color });

const ITEMS: readonly LegendItem[] = [
  {
    id: 'truth',
    label: 'True point that a radar can see',
    style: { color: both(TRUTH_COLOR), marker: 'circle' },
    line: false,
    hollow: true,
  },
  {
    id: 'outline',
    label: 'True outline',
    style: { color: { light: '#8b959e', dark: '#f0f3f5' }, width: 1 },
    line: true,
  },
  {
    id: 'field',
    label: 'Field of view',
    style: { color: { light: '#5b6670', dark: '#98a3ad' }, dash: [5, 4] },
    line: true,
  },
];

/** The signs of what is shown. */
export function legendItems(): LegendItem[] {
  const { truth, fields, source } = birdseyeState.value;
  if (source === 'street') return ITEMS.filter(({ id }) => (id === 'field' ? fields : truth));
  return ITEMS.filter(({ id }) => (id === 'field' ? fields : truth && id === 'truth')).map((item) =>
    item.id === 'truth' ? { ...item, label: 'Object the board reported' } : item,
  );
}

export function Legend() {
  const shown = legendItems();
  if (!shown.length) return null;
  return (
    <ul class="legend" aria-label="Legend">
      {shown.map((item) => (
        <li key={item.id} data-series={item.id}>
          <Swatch style={item.style} line={item.line} hollow={item.hollow ?? false} />
          <span>{item.label}</span>
        </li>
      ))}
    </ul>
  );
}
