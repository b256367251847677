/** Points on a plot that can be dragged or moved with the keyboard. */
import type { Plot } from './plot.ts';

export interface HandlePoint {
  x: number;
  y: number;
  label: string;
}

export interface HandleActions {
  /** A drag: where the point was put. */
  move(index: number, x: number, y: number): void;
  /** The keyboard: arrows by `dx` steps of the axis, plus and minus by `dy`; `coarse` with shift held. */
  nudge(index: number, dx: number, dy: number, coarse: boolean): void;
  remove(index: number): void;
}

/** Buttons over the plot, one a point, moved along with it. */
export class Handles {
  #plot: Plot;
  #actions: HandleActions;
  #points: readonly HandlePoint[] = [];
  #buttons: HTMLButtonElement[] = [];
  #layer: HTMLElement;
  #stop: () => void;

  constructor(plot: Plot, actions: HandleActions) {
    this.#plot = plot;
    this.#actions = actions;
    this.#layer = document.createElement('div');
    plot.u.over.append(this.#layer);
    this.#stop = plot.onDraw(() => this.#place());
  }

  set(points: readonly HandlePoint[]): void {
    this.#points = points;
    while (this.#buttons.length > points.length) this.#buttons.pop()?.remove();
    while (this.#buttons.length < points.length) this.#buttons.push(this.#button(this.#buttons.length));
    points.forEach((point, i) => this.#buttons[i]?.setAttribute('aria-label', point.label));
    this.#place();
  }

  focus(index: number): void {
    this.#buttons[index]?.focus();
  }

  destroy(): void {
    this.#stop();
    this.#layer.remove();
  }

  #place(): void {
    const { u, view } = this.#plot;
    this.#points.forEach((point, i) => {
      const button = this.#buttons[i];
      if (!button) return;
      const inside = point.x >= view.x[0] && point.x <= view.x[1];
      button.hidden = !inside;
      const top = Math.min(Math.max(u.valToPos(point.y, 'y'), 0), u.over.clientHeight);
      button.style.left = `${u.valToPos(point.x, 'x')}px`;
      button.style.top = `${top}px`;
    });
  }

  #button(index: number): HTMLButtonElement {
    const button = document.createElement('button');
    button.type = 'button';
    button.className = 'plot-handle';
    button.dataset.target = String(index);
    button.title = 'Drag: angle and power. Keys: arrows 0.1° (Shift: 1°), + and − power, Delete removes.';
    let held: { dx: number; dy: number } | null = null;
    button.addEventListener('pointerdown', (event) => {
      if (event.button !== 0) return;
      const box = button.getBoundingClientRect();
      held = { dx: event.clientX - (box.left + box.width / 2), dy: event.clientY - (box.top + box.height / 2) };
      button.setPointerCapture(event.pointerId);
      button.focus();
      event.preventDefault();
    });
    button.addEventListener('pointermove', (event) => {
      if (!held) return;
      const box = this.#plot.u.over.getBoundingClientRect();
      this.#actions.move(
        index,
        this.#plot.u.posToVal(event.clientX - held.dx - box.left, 'x'),
        this.#plot.u.posToVal(event.clientY - held.dy - box.top, 'y'),
      );
    });
    const release = (): void => {
      held = null;
    };
    button.addEventListener('pointerup', release);
    button.addEventListener('pointercancel', release);
    // The plot beneath must not take these for a zoom.
    for (const type of ['mousedown', 'mouseup', 'click'] as const) {
      button.addEventListener(type, (event) => event.stopPropagation());
    }
    button.addEventListener('dblclick', (event) => {
      event.stopPropagation();
      this.#actions.remove(index);
    });
    button.addEventListener('keydown', (event) => this.#key(event, index));
    this.#layer.append(button);
    return button;
  }

  #key(event: KeyboardEvent, index: number): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const steps: Record<string, [number, number]> = {
      ArrowLeft: [-1, 0],
      ArrowRight: [1, 0],
      ArrowUp: [0, 1],
      ArrowDown: [0, -1],
      '+': [0, 1],
      '=': [0, 1],
      '-': [0, -1],
      _: [0, -1],
    };
    const step = steps[event.key];
    if (step)
      this.#actions.nudge(
        index,
        this.#plot.direction * step[0],
        step[1],
        event.shiftKey && event.key.startsWith('Arrow'),
      );
    else if (event.key === 'Delete' || event.key === 'Backspace') this.#actions.remove(index);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }
}
