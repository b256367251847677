/** What a page is for, and examples to begin with. */
import { INTRODUCTIONS } from '../examples.ts';
import { canonical } from '../state/address.ts';
import { LOOKING } from '../state/history.ts';
import { type Page, pageAddress, shownParams } from '../state/route.ts';

/** Whether the page shows an example. */
function isShown(page: Page, example: URLSearchParams): boolean {
  const [wanted, shown] = [canonical(page, example), new URLSearchParams(shownParams.value)].map((params) => {
    for (const key of LOOKING) if (!example.has(key)) params.delete(key);
    return params.toString();
  });
  return wanted === shown;
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
                aria-current={isShown(page, example) ? 'true' : undefined}
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
