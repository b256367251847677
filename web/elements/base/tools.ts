/** Buttons that zoom and save a plot. */
import { made, mark } from '../made.ts';

export type Saved = 'png' | 'svg' | 'csv';

export interface ToolActions {
  /** Shows less for a factor below 1. */
  zoom(factor: number): void;
  reset(): void;
  save(as: Saved): void;
}

export class Tools {
  readonly bar = made('div', 'tools');
  readonly #closer: HTMLButtonElement;
  readonly #csv: HTMLButtonElement;

  constructor({ zoom, reset, save }: ToolActions) {
    this.bar.setAttribute('role', 'group');
    const file = (as: Saved, title: string): HTMLButtonElement => {
      const button = tool(as.toUpperCase(), title, () => save(as));
      button.dataset.export = as;
      return button;
    };
    this.#closer = tool('+', '', () => zoom(0.5));
    this.#closer.setAttribute('aria-label', 'Zoom in');
    const wider = tool('−', 'Zoom out (−)', () => zoom(2));
    wider.setAttribute('aria-label', 'Zoom out');
    this.#csv = file('csv', 'Save the numbers with a header row');
    this.bar.append(
      this.#closer,
      wider,
      tool('Reset', 'Show everything again (0)', reset),
      file('png', 'Save the plot as an image, at twice the screen’s resolution'),
      file('svg', 'Save the plot as a drawing, whose lines and text stay sharp'),
      this.#csv,
    );
  }

  set(heading: string, { navigate, numbers }: { navigate: boolean; numbers: boolean }): void {
    mark(this.bar, 'aria-label', heading ? `${heading}: tools` : 'Tools');
    mark(
      this.#closer,
      'title',
      `Zoom in (+). Drag across the plot${navigate ? ' with Shift' : ''} to zoom to a region.`,
    );
    this.#csv.hidden = !numbers;
  }
}

function tool(text: string, title: string, act: () => void): HTMLButtonElement {
  const button = document.createElement('button');
  Object.assign(button, { type: 'button', textContent: text, title });
  button.setAttribute('part', 'tool');
  button.addEventListener('click', act);
  return button;
}
