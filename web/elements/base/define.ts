/** Defines an element unless its name is taken: a cell of a notebook may run twice. Does nothing on a server. */
export function defineElement(name: string, made: CustomElementConstructor): void {
  if (globalThis.customElements && !customElements.get(name)) customElements.define(name, made);
}
