/** Keys of plots over time: space plays and stops, arrows go to the next frame, with shift ten on. */
export function frameKeys(toggle: () => void, step: (frames: number) => void): (event: KeyboardEvent) => boolean {
  return ({ key, shiftKey }) => {
    const frames = shiftKey ? 10 : 1;
    if (key === ' ') toggle();
    else if (key === 'ArrowLeft') step(-frames);
    else if (key === 'ArrowRight') step(frames);
    else return false;
    return true;
  };
}
