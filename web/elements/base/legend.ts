/** The list of what is drawn, with values where the cursor is. */
import { paintSwatch } from '../../plots/layers.ts';
import type { PlotTheme, ThemeName } from '../../plots/theme.ts';
import type { CursorPosition } from '../../plots/types.ts';
import { made, mark, say } from '../made.ts';
import type { LegendItem } from './drawing.ts';

export class Legend {
  readonly list = made('ul', 'legend');
  #items: readonly LegendItem[] = [];
  #values: (HTMLElement | null)[] = [];
  #key = '';

  constructor() {
    this.list.id = 'legend';
    this.list.setAttribute('aria-label', 'Legend');
  }

  /** Lists items afresh where their looks or words changed. */
  set(items: readonly LegendItem[], palette: PlotTheme, theme: ThemeName): void {
    this.#items = items;
    const looks = items.map(({ id, label, style, line, hollow, value }) => [id, label, style, line, hollow, !value]);
    const key = JSON.stringify([theme, palette.background, looks]);
    if (key === this.#key) return;
    this.#key = key;
    this.#values = [];
    this.list.replaceChildren(
      ...items.map((item) => {
        const entry = document.createElement('li');
        mark(entry, 'data-series', item.id ?? null);
        const swatch = document.createElement('canvas');
        swatch.setAttribute('aria-hidden', 'true');
        paintSwatch(swatch, item, palette, theme);
        const label = document.createElement('span');
        label.textContent = item.label;
        entry.append(swatch, label);
        const value = item.value ? made('span', 'value') : null;
        if (value) entry.append(value);
        this.#values.push(value);
        return entry;
      }),
    );
  }

  /** Shows the values at a place, or those at rest. */
  point(position: CursorPosition | null): void {
    this.#values.forEach((value, i) => {
      const item = this.#items[i];
      if (value && item?.value) say(value, position ? item.value(position) : (item.rest ?? '–'));
    });
  }
}
