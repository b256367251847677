/** A vertical line over a plot that moves without the plot being drawn anew. */
import type { Plot } from './plot.ts';

export class Playhead {
  #plot: Plot;
  #line = document.createElement('div');
  #at = Number.NaN;
  #stop: () => void;

  constructor(plot: Plot) {
    this.#plot = plot;
    this.#line.className = 'playhead';
    plot.u.over.append(this.#line);
    this.#stop = plot.onDraw(() => this.#place());
  }

  set(x: number): void {
    this.#at = x;
    this.#place();
  }

  destroy(): void {
    this.#stop();
    this.#line.remove();
  }

  #place(): void {
    const left = this.#plot.u.valToPos(this.#at, 'x');
    const inside = left >= 0 && left <= this.#plot.u.over.clientWidth;
    this.#line.hidden = !inside;
    if (inside) this.#line.style.transform = `translateX(${left}px)`;
  }
}
