/** The plot of an element and what stands over it: points that people move, and a line that moves by itself. */
import { Handles } from '../../plots/handles.ts';
import { Playhead } from '../../plots/playhead.ts';
import { Plot } from '../../plots/plot.ts';
import type { ThemeName } from '../../plots/theme.ts';
import type { Axes, CursorPosition, View } from '../../plots/types.ts';
import type { MovablePoints } from './drawing.ts';

/** What a stage asks of its element. */
export interface StageOwner {
  /** Tells an event; whether its default is to be left out. */
  tell(name: string, detail: unknown, cancelable?: boolean): boolean;
  point(position: CursorPosition | null): void;
  movable(): MovablePoints | null;
  /** Clicks and keys that are the element's own, unless the page took them. */
  pick(position: CursorPosition): void;
  key(event: KeyboardEvent): boolean;
  /** A point was moved, wherever the page then has it. */
  moved(): void;
}

export class Stage {
  plot: Plot | undefined;
  readonly #host: HTMLElement;
  readonly #owner: StageOwner;
  /** What the plot was made with. */
  #key = '';
  #handles: Handles | undefined;
  #line: Playhead | undefined;

  constructor(host: HTMLElement, owner: StageOwner) {
    this.#host = host;
    this.#owner = owner;
  }

  /** The part that is shown; `null` all of it. */
  get zoom(): View | null {
    return this.plot?.zoomed ? this.plot.view : null;
  }

  /** The plot, made anew where other axes are wanted. */
  on(
    axes: Axes,
    { group, label, theme }: { group: string | null; label: string; theme: ThemeName },
  ): { plot: Plot; again: boolean } {
    const key = JSON.stringify([axes, group]);
    if (this.plot && key === this.#key) {
      this.#host.setAttribute('aria-label', label);
      return { plot: this.plot, again: false };
    }
    this.discard();
    this.#key = key;
    const { tell, point, pick, key: ownKey } = this.#owner;
    this.plot = new Plot(this.#host, {
      ...axes,
      ...(group ? { cursorKey: group } : {}),
      label,
      theme,
      onCursor: point,
      onClick: (position) => {
        tell('boresight-select', position);
        pick(position);
      },
      onDoubleClick: (position) => tell('boresight-double-click', position, true),
      onView: (view, zoomed) => tell('boresight-view', { ...view, zoomed }),
      onKey: (event) => tell('boresight-key', event, true) || ownKey(event),
    });
    return { plot: this.plot, again: true };
  }

  /** Places the points, if the element has any. */
  setPoints(): void {
    const { plot } = this;
    const movable = this.#owner.movable();
    if (!plot || !movable) {
      this.#handles?.destroy();
      this.#handles = undefined;
      return;
    }
    const { points, steps, help } = movable;
    this.#handles ??= new Handles(plot, {
      move: (index, x, y) => {
        this.#owner.tell('boresight-drag', { index, x, y });
        this.#owner.moved();
      },
      remove: (index) => {
        this.#owner.tell('boresight-remove', { index });
        requestAnimationFrame(() => this.#focus(index));
      },
    });
    this.#handles.set(points, steps, help);
  }

  /** Places the line; nowhere if it is not a number. */
  setLine(x: number): void {
    if (Number.isFinite(x) && this.plot) this.#line ??= new Playhead(this.plot);
    this.#line?.set(x);
  }

  discard(): void {
    this.#handles?.destroy();
    this.#line?.destroy();
    this.plot?.destroy();
    this.#handles = this.#line = this.plot = undefined;
  }

  /** The focus goes to the point after one that went, to the last, or to the plot. */
  #focus(index: number): void {
    const last = (this.#owner.movable()?.points.length ?? 0) - 1;
    if (last >= 0) this.#handles?.focus(Math.min(index, last));
    else this.#host.focus();
  }
}
