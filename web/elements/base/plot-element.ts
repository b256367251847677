/** What all elements of a plot have in common. */
import { type Picture, png, svg } from '../../plots/picture.ts';
import { download, fileName } from '../../plots/save.ts';
import { type PlotTheme, THEMES } from '../../plots/theme.ts';
import type { Axes, CursorPosition, View } from '../../plots/types.ts';
import { paletteOf, themeOf } from './colours.ts';
import type { Drawing, MovablePoints } from './drawing.ts';
import { Frame } from './frame.ts';
import { Stage } from './stage.ts';
import type { Saved } from './tools.ts';

/** On a server there are no elements: the class is there and is never made one of. */
export const ElementBase = (globalThis.HTMLElement ?? class {}) as typeof HTMLElement;

/**
 * A plot as an element: data come as properties, settings as attributes. Data that come faster than the screen are drawn once
 * a frame.
 *
 * @attr {string} cursor-group - plots of one group share their cursor's abscissa, those of places the whole of it
 * @attr {string} detail - what of it is shown, beside the heading
 * @attr {string} file-name - names files that are saved; what the element shows by default
 * @attr {string} heading - above the plot
 * @attr {string} hint - how to use it, said below the plot
 * @attr {string} keys - what keys do beside the plot's own, for screen readers
 * @attr {'image' | 'none'} legend - the legend is on saved pictures alone, where the page has one of its own, or nowhere
 * @attr {'light' | 'dark' | 'auto'} theme - colours; those of the system by default
 * @attr {boolean} tools - buttons that zoom and save
 * @fires boresight-cursor - the cursor points somewhere (`detail`: x, y, index) or nowhere (`detail`: null)
 * @fires boresight-select - a click (`detail`: x, y, index)
 * @fires boresight-double-click - a double click (`detail`: x, y, index); prevented, it does not reset the zoom
 * @fires boresight-view - the plot was zoomed or moved (`detail`: x, y, zoomed)
 * @fires boresight-key - a key while the plot has the focus (`detail`: the event); prevented, the plot does not use it
 * @fires boresight-drag - a point was moved, by pointer or keys (`detail`: index, x, y)
 * @fires boresight-remove - a point is to go (`detail`: index)
 * @csspart figure - all of it
 * @csspart head - the row of heading, detail and tools
 * @csspart heading - its heading
 * @csspart detail - what is beside the heading
 * @csspart tools - the buttons
 * @csspart tool - a button
 * @csspart readout - what the cursor points at
 * @csspart plot - the plot with its axes
 * @csspart legend - the list of what is drawn
 * @csspart remarks - what is said below
 * @slot - between the plot and its legend
 * @slot actions - buttons of one's own beside the heading
 * @cssprop --boresight-plot-height - the least height of the plot
 */
export abstract class PlotElement extends ElementBase {
  static get observedAttributes(): string[] {
    return ['cursor-group', 'detail', 'file-name', 'heading', 'hint', 'keys', 'legend', 'theme', 'tools'];
  }

  #frame: Frame | undefined;
  #stage: Stage | undefined;
  #request = 0;
  #due = false;
  /** What has to be done anew when it is drawn next. */
  #stale = { drawing: true, colours: true, zoom: false };
  #cursor: CursorPosition | null = null;
  #drawing: Drawing | null = null;
  #palette: PlotTheme = THEMES.light;
  #scheme: MediaQueryList | undefined;
  #zoom: View | null = null;
  #remarks: readonly string[] = [];
  #caption: (() => readonly string[]) | null = null;
  #playhead = Number.NaN;

  /** @internal */
  protected abstract axes(): Axes;

  /** @internal What to draw; null without data. */
  protected abstract draw(): Drawing | null;

  /** @internal Points that people move. */
  protected movablePoints(): MovablePoints | null {
    return null;
  }

  /** @internal A click. */
  protected pick(_position: CursorPosition): void {}

  /** @internal A key; whether it was used. */
  protected key(_event: KeyboardEvent): boolean {
    return false;
  }

  /** @internal What its own keys do, in words. */
  protected keyHelp(): string {
    return '';
  }

  /** @internal Tells a screen reader. */
  protected announce(text: string): void {
    this.#frame?.announce(text);
  }

  /** @internal Above the plot, below the heading; built once. */
  protected build(_above: HTMLElement): void {}

  /** @internal After each drawing. */
  protected update(_drawing: Drawing | null): void {}

  /** The part that is shown; `null` all of it. Setting it tells no event. */
  get zoom(): View | null {
    return this.#stale.zoom ? this.#zoom : (this.#stage?.zoom ?? null);
  }

  set zoom(given: View | null) {
    this.#zoom = given || null;
    this.#stale.zoom = true;
    this.#soon();
  }

  /** Said below the plot and on saved pictures. */
  get remarks(): readonly string[] {
    return this.#remarks;
  }

  set remarks(given: readonly string[] | null) {
    this.#remarks = given || [];
    this.#soon();
  }

  /** Gives what saved pictures say below the plot, a paragraph each; the remarks by default. */
  get caption(): (() => readonly string[]) | null {
    return this.#caption;
  }

  set caption(given: (() => readonly string[]) | null) {
    this.#caption = given || null;
  }

  /** Where a vertical line stands over the plot, which is not drawn anew as it moves; not a number for none. */
  get playhead(): number {
    return this.#playhead;
  }

  set playhead(given: number | null) {
    this.#playhead = typeof given === 'number' ? given : Number.NaN;
    this.#stage?.setLine(this.#playhead);
  }

  connectedCallback(): void {
    this.#upgrade();
    if (!this.#frame) {
      const root = this.attachShadow({ mode: 'open' });
      this.#frame = new Frame(root, {
        zoom: (factor) => this.#stage?.plot?.zoomBy(factor),
        reset: () => this.resetZoom(),
        save: (as) => void this.#save(as),
      });
      this.#stage = new Stage(this.#frame.plot, {
        tell: (name, detail, cancelable) => this.tell(name, detail, cancelable),
        point: (position) => this.#point(position),
        movable: () => this.movablePoints(),
        pick: (position) => this.pick(position),
        key: (event) => this.key(event),
        moved: () => this.#soon(),
      });
      this.build(this.#frame.above);
    }
    this.#scheme = matchMedia('(prefers-color-scheme: dark)');
    this.#scheme.addEventListener('change', this.#recolour);
    this.#stale.zoom ||= this.#zoom !== null;
    this.#recolour();
    this.changed();
  }

  disconnectedCallback(): void {
    cancelAnimationFrame(this.#request);
    [this.#request, this.#due, this.#cursor] = [0, false, null];
    this.#scheme?.removeEventListener('change', this.#recolour);
    this.#scheme = undefined;
    this.#zoom = this.zoom;
    this.#stage?.discard();
    this.#frame?.close();
  }

  attributeChangedCallback(name: string): void {
    if (name === 'theme') this.#recolour();
    else if (PlotElement.observedAttributes.includes(name)) this.#soon();
    else this.changed();
  }

  /** Shows all there is again. */
  resetZoom(): void {
    this.#stage?.plot?.resetZoom();
  }

  /** The plot as a picture, with heading, legend and caption, as its tools save it. */
  async picture(as: 'png' | 'svg' = 'png'): Promise<Blob> {
    this.#render();
    const plot = this.#stage?.plot;
    if (!plot) throw new Error('An element has a picture once it is in a document.');
    const words = [this.getAttribute('heading'), this.getAttribute('detail')].filter(Boolean);
    const what: Picture = {
      heading: words.join(', '),
      legend: (this.getAttribute('legend') !== 'none' && this.#drawing?.legend) || [],
      caption: this.#caption ? this.#caption() : this.#remarks,
    };
    return (as === 'png' ? png : svg)(plot, what);
  }

  /** What is shown as CSV with a header row; empty where there are no numbers. */
  csv(): string {
    this.#render();
    return this.#drawing?.csv?.() ?? '';
  }

  /** @internal Draws again: at once, and then no more until the next frame of the screen. */
  protected changed(): void {
    this.#stale.drawing = true;
    this.#soon();
  }

  /** @internal Whether a default is to be left out. */
  protected tell(name: string, detail: unknown, cancelable = false): boolean {
    return !this.dispatchEvent(new CustomEvent(name, { detail, bubbles: true, composed: true, cancelable }));
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

  #soon(): void {
    if (this.#due || !this.#frame || !this.isConnected) return;
    this.#due = true;
    // All that is set in one go is drawn at once; what comes before the next frame of the screen waits for that.
    if (!this.#request) queueMicrotask(this.#render);
  }

  #render = (): void => {
    const [frame, stage] = [this.#frame, this.#stage];
    if (!this.#due || !frame || !stage || !this.isConnected) return;
    this.#due = false;
    this.#request ||= requestAnimationFrame(() => {
      this.#request = 0;
      this.#render();
    });
    const theme = themeOf(this);
    const { drawing: fresh, colours, zoom } = this.#stale;
    this.#stale = { drawing: false, colours: false, zoom: false };
    if (fresh) this.#drawing = this.draw();
    if (colours) this.#palette = paletteOf(this, frame.figure);
    const drawing = this.#drawing;
    const axes = this.axes();
    const said = (name: string): string => this.getAttribute(name) ?? '';
    frame.legend.set(drawing?.legend ?? [], this.#palette, theme);
    frame.set(drawing, {
      heading: said('heading'),
      detail: said('detail'),
      remarks: this.#remarks,
      hint: said('hint'),
      tools: this.hasAttribute('tools'),
      legend: !said('legend'),
      navigate: axes.navigate ?? false,
    });
    const { plot, again } = stage.on(axes, {
      group: this.getAttribute('cursor-group'),
      label: this.#label(axes),
      theme,
    });
    if (colours || again) plot.setTheme(theme, this.#palette);
    const content = drawing?.content ?? { x: [], series: [], extent: plot.content.extent };
    if (plot.content !== content) plot.setContent(content);
    if (zoom) plot.setView(this.#zoom);
    stage.setPoints();
    stage.setLine(this.#playhead);
    frame.point(drawing, this.#cursor);
    if (fresh) this.update(drawing);
  };

  #label({ navigate }: Axes): string {
    const own = this.getAttribute('keys') ?? (navigate ? 'Arrows move, with Shift the cursor.' : this.keyHelp());
    const heading = this.getAttribute('heading') ?? this.localName.replace('boresight-', '').replaceAll('-', ' ');
    return [
      `${heading}.`,
      own,
      'Plus and minus zoom, 0 resets.',
      /arrows/i.test(own) ? '' : 'Left and right move the cursor.',
    ]
      .filter(Boolean)
      .join(' ');
  }

  #point(position: CursorPosition | null): void {
    this.#cursor = position;
    this.#frame?.point(this.#drawing, position);
    if (position && this.#frame?.focused) this.#frame.announce();
    this.tell('boresight-cursor', position);
  }

  async #save(as: Saved): Promise<void> {
    const content = as === 'csv' ? this.csv() : await this.picture(as);
    const name = this.getAttribute('file-name') ?? this.localName.replace('boresight-', '');
    download(content, fileName([name], as));
  }

  #recolour = (): void => {
    this.#stale.colours = true;
    this.#soon();
  };
}
