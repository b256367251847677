/** Sends what is drawn on a canvas to another context, which need not be one of a canvas. */
export function divert(from: CanvasRenderingContext2D, to: CanvasRenderingContext2D): void {
  type Member = keyof CanvasRenderingContext2D;
  for (const key in from) {
    const name = key as Member;
    if (name === 'canvas') continue;
    const own: PropertyDescriptor =
      typeof from[name] === 'function'
        ? { value: (...given: unknown[]) => (to[name] as (...all: unknown[]) => unknown)(...given) }
        : {
            get: () => to[name],
            set: (value: unknown) => {
              (to as unknown as Record<string, unknown>)[name] = value;
            },
          };
    Object.defineProperty(from, name, { configurable: true, ...own });
  }
  // What is drawn on is empty.
  Object.defineProperty(from, 'clearRect', { configurable: true, value: () => {} });
}
