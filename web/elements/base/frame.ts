/** What is around a plot: heading, tools, readout, legend, remarks, and all that a screen reader is told. */
import type { CursorPosition } from '../../plots/types.ts';
import { made, mark, say } from '../made.ts';
import type { Drawing } from './drawing.ts';
import { Legend } from './legend.ts';
import { styles } from './styles.ts';
import { type ToolActions, Tools } from './tools.ts';

/** What a frame says beside the drawing. */
export interface Words {
  heading: string;
  detail: string;
  remarks: readonly string[];
  hint: string;
  tools: boolean;
  /** Whether the legend is listed here. */
  legend: boolean;
  navigate: boolean;
}

/** How long the cursor rests before a screen reader is told where, ms. */
const REST_MS = 250;
const AT_REST = 'Cursor: point at the plot';

export class Frame {
  readonly figure = made('figure', 'figure');
  /** Above the plot, for an element's own. */
  readonly above = made('div', 'above');
  readonly plot = made('div', 'plot');
  readonly legend = new Legend();
  readonly #root: ShadowRoot;
  readonly #heading = made('div', 'heading');
  readonly #detail = made('span', 'detail');
  readonly #readout = made('p', 'readout');
  readonly #remarks = made('figcaption', 'remarks');
  readonly #alternative = made('p', 'alternative');
  readonly #live = made('p', 'live');
  readonly #tools: Tools;
  #said: ReturnType<typeof setTimeout> | undefined;

  constructor(root: ShadowRoot, actions: ToolActions) {
    this.#root = root;
    root.adoptedStyleSheets = [styles()];
    this.#tools = new Tools(actions);
    for (const [name, part] of [
      ['heading', this.#heading],
      ['detail', this.#detail],
      ['remarks', this.#remarks],
      ['alternative', this.#alternative],
    ] as const)
      part.id = name;
    this.#heading.setAttribute('role', 'heading');
    this.#heading.setAttribute('aria-level', '3');
    this.#live.setAttribute('role', 'status');
    const own = Object.assign(document.createElement('slot'), { name: 'actions' });
    own.addEventListener('slotchange', () => {
      head.classList.toggle('with-actions', own.assignedNodes().length > 0);
    });
    const head = made('div', 'head');
    head.append(this.#heading, this.#detail, own, this.#tools.bar);
    this.figure.append(
      head,
      this.above,
      this.#readout,
      this.plot,
      document.createElement('slot'),
      this.legend.list,
      this.#remarks,
      this.#alternative,
      this.#live,
    );
    root.append(this.figure);
  }

  /** Whether keys go to the plot. */
  get focused(): boolean {
    return this.#root.activeElement === this.plot;
  }

  set(drawing: Drawing | null, { heading, detail, remarks, hint, tools, legend, navigate }: Words): void {
    say(this.#heading, heading);
    say(this.#detail, detail);
    const text = [...remarks, hint].filter(Boolean).join(' ');
    say(this.#remarks, text);
    const alternative = drawing ? (drawing.alternative ?? '') : 'No data yet.';
    say(this.#alternative, alternative);
    this.#tools.bar.hidden = !tools;
    this.#tools.set(heading, { navigate, numbers: Boolean(drawing?.csv) });
    const listed = legend && Boolean(drawing?.legend?.length);
    this.legend.list.hidden = !listed;
    mark(this.figure, 'aria-labelledby', heading ? this.#heading.id : null);
    const described = [
      detail && this.#detail.id,
      listed && this.legend.list.id,
      text && this.#remarks.id,
      alternative && this.#alternative.id,
    ].filter(Boolean);
    mark(this.plot, 'aria-describedby', described.join(' ') || null);
  }

  /** Says what the cursor points at. */
  point(drawing: Drawing | null, position: CursorPosition | null): void {
    say(this.#readout, position && drawing ? drawing.readout(position) : AT_REST);
    this.#readout.classList.toggle('resting', !position);
    this.legend.point(position);
  }

  /** Has a screen reader say something, what the cursor points at by default, once all rests. */
  announce(text = this.#readout.textContent ?? ''): void {
    clearTimeout(this.#said);
    this.#said = setTimeout(() => say(this.#live, text), REST_MS);
  }

  close(): void {
    clearTimeout(this.#said);
    this.plot.replaceChildren();
  }
}
