/** Asks for what a page needs while the signal processing is still on its way, in place of after it. */
import { pool } from './data.ts';
import { askAhead as askForCapture } from './pages/capture/ahead.ts';
import { askAhead as askForDrive } from './pages/mounting/ahead.ts';
import { askAhead as askForNetwork } from './pages/networks/ahead.ts';
import type { Page, Route } from './state/route.ts';

const FILES: Partial<Record<Page, (params: URLSearchParams) => void>> = {
  capture: askForCapture,
  mounting: askForDrive,
  networks: askForNetwork,
};

export function askAhead({ page, params }: Route): void {
  FILES[page]?.(params);
  // A worker starts meanwhile, where the first picture needs one. What goes wrong is told where it is needed.
  const start = { capture: 'version', birdseye: 'version', mounting: 'driveScenarios' } as const;
  if (page in start)
    pool()
      [start[page as keyof typeof start]]()
      .catch(() => {});
}
