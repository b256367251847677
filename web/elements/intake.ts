/** Files for an element, chosen, dropped or given, and the work on them with its progress, cancelling and errors. */
import type { Pool } from 'boresight/worker';
import { acquire, release } from './pool.ts';

/** A file by its name. */
export interface NamedBytes {
  name: string;
  bytes: Uint8Array;
}

export interface Work {
  pool: Pool;
  signal: AbortSignal;
  onProgress(done: number, total: number): void;
}

export class Intake {
  /** The controls, for the element to place. */
  readonly bar = document.createElement('div');
  readonly #host: HTMLElement;
  readonly #take: (files: NamedBytes[]) => void;
  readonly #progress = document.createElement('progress');
  readonly #cancel = button('Cancel');
  readonly #said = document.createElement('span');
  readonly #problem = document.createElement('p');
  #running: AbortController | null = null;
  #pool: Pool | null = null;

  constructor(host: HTMLElement, what: string, accept: string, take: (files: NamedBytes[]) => void) {
    this.#host = host;
    this.#take = take;
    this.bar.className = 'bar';
    this.bar.setAttribute('part', 'bar');
    const input = Object.assign(document.createElement('input'), {
      type: 'file',
      multiple: true,
      accept,
      hidden: true,
    });
    input.setAttribute('aria-label', what);
    const open = button(`Open ${what}`);
    open.addEventListener('click', () => input.click());
    input.addEventListener('change', () => {
      void this.open(input.files ?? []);
      input.value = '';
    });
    this.#cancel.hidden = this.#progress.hidden = this.#problem.hidden = true;
    this.#progress.setAttribute('aria-label', 'Progress');
    this.#cancel.addEventListener('click', () => this.stop());
    this.#problem.className = 'problem';
    this.#problem.setAttribute('part', 'problem');
    this.#problem.setAttribute('role', 'alert');
    this.bar.append(open, input, this.#said, this.#progress, this.#cancel, this.#problem);
    host.addEventListener('dragover', this.#over);
    host.addEventListener('drop', this.#drop);
  }

  /** Reads files and hands them on. */
  async open(files: Iterable<File>): Promise<void> {
    const all = [...files];
    if (!all.length) return;
    try {
      const read = async (file: File): Promise<NamedBytes> => ({
        name: file.name,
        bytes: new Uint8Array(await file.arrayBuffer()),
      });
      this.#take(await Promise.all(all.map(read)));
    } catch (problem) {
      this.fail(problem);
    }
  }

  /** Does work that may take long; what was under way is stopped. Gives nothing where it failed or was stopped. */
  async run<T>(said: string, work: (to: Work) => Promise<T>): Promise<T | undefined> {
    this.stop();
    const controller = new AbortController();
    this.#running = controller;
    this.#problem.hidden = true;
    this.#said.textContent = said;
    this.#progress.removeAttribute('value');
    this.#cancel.hidden = this.#progress.hidden = false;
    this.#pool ??= acquire();
    const pool = this.#pool;
    try {
      return await work({
        pool,
        signal: controller.signal,
        onProgress: (done, total) => {
          if (total > 0) this.#progress.value = done / total;
        },
      });
    } catch (problem) {
      if (!controller.signal.aborted) this.fail(problem);
      return undefined;
    } finally {
      if (this.#running === controller) this.#idle();
    }
  }

  /** Stops, and gives the pool back until there is work again. */
  close(): void {
    this.stop();
    if (this.#pool) release();
    this.#pool = null;
  }

  stop(): void {
    this.#running?.abort();
    this.#idle();
  }

  #idle(): void {
    this.#running = null;
    this.#cancel.hidden = this.#progress.hidden = true;
    this.#said.textContent = '';
  }

  /** Shows what went wrong, and tells the host. */
  fail(problem: unknown): void {
    this.#problem.textContent = problem instanceof Error ? problem.message : String(problem);
    this.#problem.hidden = false;
    this.#host.dispatchEvent(new CustomEvent('boresight-error', { detail: problem, bubbles: true, composed: true }));
  }

  #over = (event: DragEvent): void => event.preventDefault();

  #drop = (event: DragEvent): void => {
    event.preventDefault();
    void this.open(event.dataTransfer?.files ?? []);
  };
}

function button(text: string): HTMLButtonElement {
  return Object.assign(document.createElement('button'), { type: 'button', textContent: text });
}
