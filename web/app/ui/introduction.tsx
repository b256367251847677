/** What a page is for, and examples to begin with. */
import { INTRODUCTIONS } from '../examples.ts';
import { type Page, pageAddress, shownParams } from '../state/route.ts';

/** Parameters that say where one looks, whatever the example. */
const LOOKING = ['t', 'view', 'cell', 'frame'];

/** Whether the page shows an example: what its address leaves out is as it usually is. */
function isShown(example: URLSearchParams): boolean {
  const shown = shownParams.value;
  const keys = new Set([...example.keys(), ...shown.keys()]);
  for (const key of LOOKING) if (!example.has(key)) keys.delete(key);
  return [...keys].every((key) => example.has(key) && (!shown.has(key) || shown.get(key) === example.get(key)));
}

export function Introduction({ page }: { page: Page }) {
  const { about, examples } = INTRODUCTIONS[page];
  return (
    <section class="introduction" aria-label="Introduction">
      <p>{about}</p>
      <ul aria-label="Examples">
        {examples.map(({ title, about: shows, params }) => {
          const example = new URLSearchParams(params);
          return (
            <li key={title}>
              <a
                class="chip"
                href={pageAddress(page, example)}
                title={shows}
                aria-current={isShown(example) ? 'true' : undefined}
              >
                {title}
              </a>
            </li>
          );
        })}
      </ul>
    </section>
  );
}
