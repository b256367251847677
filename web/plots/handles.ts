/** Points on a plot that can be dragged or moved with the keyboard. */
import type { Plot } from './plot.ts';
import type { HandlePoint, HandleSteps } from './types.ts';

export interface HandleActions {
  /** Where the point was put, by a drag or by the keyboard. */
  move(index: number, x: number, y: number): void;
  remove(index: number): void;
}

/** Buttons over the plot, one a point, moved along with it. */
export class Handles {
  #plot: Plot;
  #actions: HandleActions;
  #points: readonly HandlePoint[] = [];
  /** Points as the owner last set them. */
  #given: readonly HandlePoint[] = [];
  /** Whether a key has moved a point that the owner has not set since. */
  #ahead = false;
  #steps: HandleSteps = { x: [0.1, 1], y: [0.5, 3] };
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

  set(points: readonly HandlePoint[], steps: HandleSteps, title: string): void {
    // An owner that computes first sets the old points until it is done. The next key must not start from those.
    const unchanged =
      points.length === this.#given.length &&
      points.every((point, i) => point.x === this.#given[i]?.x && point.y === this.#given[i]?.y);
    if (!this.#ahead || !unchanged) {
      this.#points = points;
      this.#ahead = false;
    }
    this.#given = points;
    this.#steps = steps;
    while (this.#buttons.length > points.length) this.#buttons.pop()?.remove();
    while (this.#buttons.length < points.length) this.#buttons.push(this.#button(this.#buttons.length));
    points.forEach((point, i) => {
      const button = this.#buttons[i];
      if (!button) return;
      button.setAttribute('aria-label', point.label);
      if (button.title !== title) button.title = title;
    });
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
    const point = this.#points[index];
    if (step && point) {
      const coarse = Number(event.shiftKey && event.key.startsWith('Arrow'));
      const x = point.x + this.#plot.direction * step[0] * (this.#steps.x[coarse] as number);
      const y = point.y + step[1] * (this.#steps.y[coarse] as number);
      this.#points = this.#points.map((one, i) => (i === index ? { ...one, x, y } : one));
      this.#ahead = true;
      this.#actions.move(index, x, y);
      // An owner that keeps the points where they are, at a limit for example, has its way after two frames.
      requestAnimationFrame(() =>
        requestAnimationFrame(() => {
          if (!this.#ahead) return;
          this.#ahead = false;
          this.#points = this.#given;
          this.#place();
        }),
      );
    } else if (event.key === 'Delete' || event.key === 'Backspace') this.#actions.remove(index);
    else return;
    event.preventDefault();
    event.stopPropagation();
  }
}
