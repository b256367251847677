/** An element in a host that hands settings and packed data over, and is told of events. */
import { hasArrays, pack, unpack } from './codec.ts';
import { followTheme } from './theme.ts';

/** What is told of an event: a detail without arrays as it is, one with arrays packed. */
export type Told = (event: string, detail: unknown) => void;

export class Mounted {
  readonly element: HTMLElement;
  readonly #given = new Map<string, Uint8Array>();
  readonly #settings = new Map<string, unknown>();
  readonly #told: Told;
  readonly #last = new Map<string, unknown>();
  #theme: string | null = null;
  #hostTheme: string | null = null;
  #turn = 0;
  readonly #unfollow: () => void;

  constructor(host: HTMLElement | ShadowRoot, tag: string, events: readonly string[], told: Told) {
    this.element = document.createElement(tag);
    this.#told = told;
    for (const name of events)
      this.element.addEventListener(name, (event) => this.#event(name, (event as CustomEvent).detail));
    host.append(this.element);
    this.#unfollow = followTheme(this.element, (theme) => {
      this.#hostTheme = theme;
      this.#colour();
    });
  }

  /** Sets a setting, `null` takes it away; what is given again leaves what the element or its user has set since. */
  attribute(name: string, value: unknown): void {
    if ((this.#settings.get(name) ?? null) === (value ?? null)) return;
    this.#settings.set(name, value ?? null);
    if (name === 'theme') {
      this.#theme = typeof value === 'string' && value !== 'auto' ? value : null;
      this.#colour();
    } else if (value === null || value === undefined || value === false) this.element.removeAttribute(name);
    else this.element.setAttribute(name, value === true ? '' : String(value));
  }

  /** Sets data from their bytes, unless they are those it has. */
  property(name: string, packed: ArrayBufferView | null | undefined): void {
    if (!packed?.byteLength) return;
    const bytes = new Uint8Array(packed.buffer, packed.byteOffset, packed.byteLength);
    const before = this.#given.get(name);
    if (before && same(before, bytes)) return;
    this.#given.set(name, bytes.slice());
    const value = unpack(bytes);
    if (value !== null || before) (this.element as unknown as Record<string, unknown>)[name] = value;
  }

  remove(): void {
    cancelAnimationFrame(this.#turn);
    this.#unfollow();
    this.element.remove();
  }

  #colour(): void {
    const theme = this.#theme ?? this.#hostTheme;
    if (theme && this.element.getAttribute('theme') !== theme) this.element.setAttribute('theme', theme);
  }

  /** The last of each kind is told once a frame of the screen. */
  #event(name: string, detail: unknown): void {
    this.#last.set(name, detail);
    this.#turn ||= requestAnimationFrame(() => {
      this.#turn = 0;
      for (const [event, last] of this.#last) this.#told(event, tellable(last));
      this.#last.clear();
    });
  }
}

function tellable(detail: unknown): unknown {
  if (detail instanceof Error) return { code: 'code' in detail ? detail.code : null, message: detail.message };
  return hasArrays(detail) ? pack(detail) : (detail ?? null);
}

const same = (a: Uint8Array, b: Uint8Array): boolean => a.length === b.length && a.every((value, i) => value === b[i]);
