/** A plot as a map: a drag moves it, two fingers too, the wheel zooms about the pointer. */
import type { Plot } from './plot.ts';

/** A mouse wheel's usual notch is 100 px: three of them zoom to half. */
const ZOOM_A_PIXEL = Math.LN2 / 300;

export function navigate(plot: Plot): () => void {
  const { over } = plot.u;
  const fingers = new Map<number, { x: number; y: number }>();
  /** What a frame has gathered. */
  let [dx, dy, factor, frame] = [0, 0, 1, 0];
  let about = { x: 0, y: 0 };

  const place = (event: { clientX: number; clientY: number }): { x: number; y: number } => {
    const box = over.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  };
  const value = (at: { x: number; y: number }): { x: number; y: number } => ({
    x: plot.u.posToVal(at.x, 'x'),
    y: plot.u.posToVal(at.y, 'y'),
  });
  /** Events come faster than plots are drawn. */
  const soon = (): void => {
    frame ||= requestAnimationFrame(() => {
      frame = 0;
      if (factor !== 1) plot.zoomBy(factor, value(about));
      const [from, to] = [value({ x: 0, y: 0 }), value({ x: dx, y: dy })];
      if (dx || dy) plot.moveBy(from.x - to.x, from.y - to.y);
      [dx, dy, factor] = [0, 0, 1];
    });
  };
  /** Unzoomed, one finger scrolls the page. */
  const touch = (): void => {
    over.style.touchAction = plot.zoomed ? 'none' : 'pan-x pan-y';
  };

  const down = (event: PointerEvent): void => {
    if (event.button !== 0 || event.shiftKey) return;
    if (event.pointerType === 'mouse') over.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, place(event));
    over.classList.toggle('moving', plot.zoomed);
  };
  const move = (event: PointerEvent): void => {
    const before = fingers.get(event.pointerId);
    if (!before) return;
    const now = place(event);
    fingers.set(event.pointerId, now);
    const other = [...fingers].find(([id]) => id !== event.pointerId)?.[1];
    const share = other ? 0.5 : 1;
    dx += (now.x - before.x) * share;
    dy += (now.y - before.y) * share;
    if (other) {
      about = { x: (now.x + other.x) / 2, y: (now.y + other.y) / 2 };
      const distance = (from: { x: number; y: number }): number =>
        Math.max(Math.hypot(from.x - other.x, from.y - other.y), 1);
      factor *= distance(before) / distance(now);
    }
    soon();
  };
  const up = (event: PointerEvent): void => {
    fingers.delete(event.pointerId);
    if (!fingers.size) over.classList.remove('moving');
  };
  /** A wheel over a plot that nobody chose scrolls the page. */
  const wheel = (event: WheelEvent): void => {
    if (!event.ctrlKey && !plot.host.matches(':focus')) return;
    event.preventDefault();
    about = place(event);
    const pixels = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 33 * event.deltaY : event.deltaY;
    // A touchpad's pinch comes as small steps with Ctrl.
    factor *= Math.exp(pixels * ZOOM_A_PIXEL * (event.ctrlKey && Math.abs(pixels) < 50 ? 5 : 1));
    soon();
  };

  over.addEventListener('pointerdown', down);
  over.addEventListener('pointermove', move);
  for (const end of ['pointerup', 'pointercancel'] as const) over.addEventListener(end, up);
  over.addEventListener('wheel', wheel, { passive: false });
  const stop = plot.onDraw(touch);
  touch();
  return () => {
    cancelAnimationFrame(frame);
    stop();
    over.removeEventListener('pointerdown', down);
    over.removeEventListener('pointermove', move);
    for (const end of ['pointerup', 'pointercancel'] as const) over.removeEventListener(end, up);
    over.removeEventListener('wheel', wheel);
  };
}
