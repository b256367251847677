/** Live: a recorded board is replayed, paused and replayed to its end. */
import { browserTest } from '../lib/harness.mjs';

browserTest('flow: live', { path: '#/live' }, async ({ page }) => {
  await page.getByRole('button', { name: 'Bundled recording', exact: true }).click();
  const live = page.getByRole('region', { name: 'Live', exact: true });
  await live.getByRole('button', { name: 'Pause' }).click();
  await live.getByRole('button', { name: 'Go on' }).click();
  await live.getByRole('button', { name: 'Pause' }).waitFor();
  await page.getByRole('link', { name: 'All at once' }).click();
  await live.getByText('Ended').waitFor({ timeout: 60_000 });
  const points = page.getByRole('figure', { name: 'Detections' });
  await points.getByText('Frame 710').waitFor();
  await points.getByText(/6 detections of the board, xWR16xx/).waitFor();
});
