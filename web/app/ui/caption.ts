/** What a saved picture says of itself below the plot. */
import { api } from '../data.ts';
import { caption } from '../state/address.ts';
import { link, route, TITLES } from '../state/route.ts';

/** Paragraphs: what is shown, remarks on it, where it is from, and the link that shows it again. */
export function captionLines(remarks: readonly string[] = []): string[] {
  const about = caption();
  const shown = `${TITLES[route.peek().page]}: ${about?.settings ?? ''}`;
  const date = new Date().toISOString().slice(0, 10);
  return [
    ...(about ? [`${shown}.`] : []),
    ...remarks,
    [`Boresight ${api.version()}`, ...(about ? [`data: ${about.data}`] : []), date].join(' · '),
    link(),
  ];
}
