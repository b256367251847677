/** Light or dark as the host is, which need not be as the system is. */

/** Follows the host's theme until the function that it gives is called; `told` hears of the first and of each change. */
export function followTheme(host: HTMLElement, told: (theme: 'light' | 'dark') => void): () => void {
  let last = '';
  const look = (): void => {
    const theme = backdrop(host);
    if (theme === null || theme === last) return;
    last = theme;
    told(theme);
  };
  // Hosts set their theme by attributes of these two; the size changes when the host is put into the page.
  const attributes = new MutationObserver(look);
  for (const part of [document.documentElement, document.body]) attributes.observe(part, { attributes: true });
  const size = new ResizeObserver(look);
  size.observe(host);
  const scheme = matchMedia('(prefers-color-scheme: dark)');
  scheme.addEventListener('change', look);
  look();
  return () => {
    attributes.disconnect();
    size.disconnect();
    scheme.removeEventListener('change', look);
  };
}

/** By the colour behind an element; that of the system where nothing has one, and null while it is in no page. */
function backdrop(host: HTMLElement): 'light' | 'dark' | null {
  if (!host.isConnected) return null;
  for (let at: Node | null = host; at; at = at instanceof ShadowRoot ? at.host : at.parentNode) {
    if (!(at instanceof Element)) continue;
    const rgba = painted(getComputedStyle(at).backgroundColor);
    if (rgba[3] < 128) continue;
    return 0.299 * rgba[0] + 0.587 * rgba[1] + 0.114 * rgba[2] < 128 ? 'dark' : 'light';
  }
  return matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light';
}

let brush: OffscreenCanvasRenderingContext2D | null = null;

/** A colour of any notation as red, green, blue and opacity, 0 to 255. */
function painted(color: string): readonly [number, number, number, number] {
  brush ??= new OffscreenCanvas(1, 1).getContext('2d', { willReadFrequently: true });
  if (!brush) return [0, 0, 0, 0];
  brush.clearRect(0, 0, 1, 1);
  brush.fillStyle = color;
  brush.fillRect(0, 0, 1, 1);
  const [r = 0, g = 0, b = 0, a = 0] = brush.getImageData(0, 0, 1, 1).data;
  return [r, g, b, a];
}
