/** What all elements of a plot have in common. */

import { drawSwatch, SWATCH } from '../plots/layers.ts';
import type { LegendEntry } from '../plots/picture.ts';
import { type CursorPosition, Plot } from '../plots/plot.ts';
import { type PlotTheme, THEMES, type ThemeName } from '../plots/theme.ts';
import type { Axes, Drawing } from './drawing.ts';
import { styles } from './styles.ts';

/** On a server there are no elements: the class is there and is never made one of. */
export const ElementBase = (globalThis.HTMLElement ?? class {}) as typeof HTMLElement;

/** Custom properties that colour what is drawn. */
const PROPERTIES = {
  background: '--boresight-background',
  text: '--boresight-text',
  muted: '--boresight-muted',
  grid: '--boresight-grid',
  accent: '--boresight-accent',
  truth: '--boresight-truth',
  font: '--boresight-font',
} as const;

/**
 * A plot as an element: data come as properties, settings as attributes. Data that come faster than the screen are drawn once
 * a frame.
 *
 * @fires boresight-cursor - the cursor points somewhere (`detail`: x, y, index) or nowhere (`detail`: null)
 * @fires boresight-select - a click (`detail`: x, y, index)
 * @fires boresight-view - the plot was zoomed or moved (`detail`: x, y, zoomed)
 * @csspart figure - all of it
 * @csspart heading - its heading
 * @csspart readout - what the cursor points at
 * @csspart plot - the plot with its axes
 * @csspart legend - the list of what is drawn
 */
export abstract class PlotElement extends ElementBase {
  static get observedAttributes(): string[] {
    return ['heading', 'theme'];
  }

  #root: ShadowRoot | undefined;
  #plot: Plot | undefined;
  #frame = 0;
  #cursor: CursorPosition | null = null;
  #drawing: Drawing | null = null;
  #scheme: MediaQueryList | undefined;

  /** @internal */
  protected abstract axes(): Axes;

  /** @internal What to draw; null without data. */
  protected abstract draw(): Drawing | null;

  /** @internal Above the plot, beside the heading; built once. */
  protected build(_above: HTMLElement): void {}

  /** @internal After each drawing. */
  protected update(_drawing: Drawing | null): void {}

  connectedCallback(): void {
    this.#upgrade();
    this.#root ??= this.#skeleton();
    const root = this.#root;
    const host = part(root, 'plot');
    this.#plot = new Plot(host, {
      ...this.axes(),
      label: this.#label(),
      theme: this.#themeName(),
      onCursor: (position) => this.#point(position),
      onClick: (position) => this.tell('boresight-select', position),
      onView: (view, zoomed) => this.tell('boresight-view', { ...view, zoomed }),
    });
    this.#scheme = matchMedia('(prefers-color-scheme: dark)');
    this.#scheme.addEventListener('change', this.#recolour);
    this.#recolour();
    this.changed();
  }

  disconnectedCallback(): void {
    cancelAnimationFrame(this.#frame);
    this.#frame = 0;
    this.#scheme?.removeEventListener('change', this.#recolour);
    this.#scheme = undefined;
    this.#plot?.destroy();
    this.#plot = undefined;
    part(this.#root, 'plot').replaceChildren();
  }

  attributeChangedCallback(name: string): void {
    if (name === 'theme') this.#recolour();
    else this.changed();
  }

  /** Shows all there is again. */
  resetZoom(): void {
    this.#plot?.resetZoom();
  }

  /** @internal Draws again in the next frame of the screen. */
  protected changed(): void {
    if (!this.#plot || this.#frame) return;
    this.#frame = requestAnimationFrame(() => {
      this.#frame = 0;
      this.#render();
    });
  }

  /** @internal */
  protected tell(name: string, detail: unknown): void {
    const event = new CustomEvent(name, { detail, bubbles: true, composed: true });
    this.dispatchEvent(event);
  }

  /** @internal A number of an attribute, where it is one. */
  protected numberOf(name: string, absent: number): number {
    const given = this.getAttribute(name);
    const value = given === null || given.trim() === '' ? Number.NaN : Number(given);
    return Number.isFinite(value) ? value : absent;
  }

  /** Properties that were set before the element was defined are on the object itself, and hide those of the class. */
  #upgrade(): void {
    for (const name of Object.keys(this)) {
      if (!(name in Object.getPrototypeOf(this))) continue;
      const self = this as unknown as Record<string, unknown>;
      const value = self[name];
      delete self[name];
      self[name] = value;
    }
  }

  #skeleton(): ShadowRoot {
    const root = this.attachShadow({ mode: 'open' });
    root.adoptedStyleSheets = [styles()];
    const figure = made('figure', 'figure');
    const above = made('div', 'above');
    const plot = made('div', 'plot');
    const alternative = made('p', 'alternative');
    alternative.id = 'alternative';
    plot.setAttribute('aria-describedby', alternative.id);
    const readout = made('p', 'readout');
    figure.append(made('div', 'heading'), above, readout, plot, made('ul', 'legend'), alternative);
    this.build(above);
    root.append(figure);
    return root;
  }

  #label(): string {
    const heading = this.getAttribute('heading') ?? this.localName.replace('boresight-', '').replaceAll('-', ' ');
    return `${heading}. Plus and minus zoom, 0 resets. Left and right move the cursor.`;
  }

  #render(): void {
    const plot = this.#plot;
    if (!plot) return;
    const drawing = this.draw();
    this.#drawing = drawing;
    const heading = this.getAttribute('heading') ?? '';
    part(this.#root, 'heading').textContent = heading;
    plot.host.setAttribute('aria-label', this.#label());
    plot.setContent(drawing?.content ?? { x: [], series: [], extent: plot.content.extent });
    part(this.#root, 'alternative').textContent = drawing?.alternative ?? 'No data yet.';
    this.#legend(drawing?.legend ?? []);
    this.#readout();
    this.update(drawing);
  }

  #legend(entries: readonly LegendEntry[]): void {
    const theme = this.#themeName();
    const key = JSON.stringify([theme, entries.map(({ label, style, line }) => [label, style, line])]);
    const list = part(this.#root, 'legend');
    if (list.dataset.key === key) return;
    list.dataset.key = key;
    list.replaceChildren(
      ...entries.map(({ label, style, line, hollow = false }) => {
        const item = document.createElement('li');
        const swatch = document.createElement('canvas');
        const ratio = devicePixelRatio || 1;
        [swatch.width, swatch.height] = [SWATCH.width * ratio, SWATCH.height * ratio];
        [swatch.style.width, swatch.style.height] = [`${SWATCH.width}px`, `${SWATCH.height}px`];
        const ctx = swatch.getContext('2d');
        const at = { x: 0, y: swatch.height / 2, ratio };
        if (ctx) drawSwatch(ctx, { style, line, hollow }, at, THEMES[theme], theme);
        item.append(swatch, label);
        return item;
      }),
    );
  }

  #point(position: CursorPosition | null): void {
    this.#cursor = position;
    this.#readout();
    this.tell('boresight-cursor', position);
  }

  #readout(): void {
    const text = this.#cursor && this.#drawing ? this.#drawing.readout(this.#cursor) : '';
    part(this.#root, 'readout').textContent = text;
  }

  #themeName(): ThemeName {
    const asked = this.getAttribute('theme');
    if (asked === 'light' || asked === 'dark') return asked;
    return globalThis.matchMedia?.('(prefers-color-scheme: dark)').matches ? 'dark' : 'light';
  }

  #recolour = (): void => {
    if (!this.#plot || !this.#root) return;
    const name = this.#themeName();
    const given = getComputedStyle(this);
    const palette: PlotTheme = { ...THEMES[name] };
    for (const [key, property] of Object.entries(PROPERTIES) as [keyof typeof PROPERTIES, string][]) {
      const value = given.getPropertyValue(property).trim();
      if (value) palette[key] = value;
    }
    const figure = part(this.#root, 'figure');
    for (const key of ['background', 'text', 'muted', 'accent'] as const)
      figure.style.setProperty(`--${key}`, palette[key]);
    this.#plot.setTheme(name, palette);
    this.changed();
  };
}

function made(tag: string, name: string): HTMLElement {
  const element = document.createElement(tag);
  element.className = name;
  element.setAttribute('part', name);
  return element;
}

function part(root: ShadowRoot | undefined, name: string): HTMLElement {
  const found = root?.querySelector<HTMLElement>(`[part="${name}"]`);
  if (!found) throw new Error(`there is no part ${name} before the element is connected`);
  return found;
}
