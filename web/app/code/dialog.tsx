/** Shows what a page shows as code, to be copied. */
import { useSignal } from '@preact/signals';
import { useEffect, useRef } from 'preact/hooks';
import type { Code, Part } from './code.ts';
import { shownCode } from './shown.tsx';

const WAYS = [
  ['javascript', 'JavaScript'],
  ['commandLine', 'Command line'],
] as const;

type Way = (typeof WAYS)[number][0];

/** The way that was looked at last. */
let last: Way = 'javascript';

export function CodeDialog({ code }: { code: Code }) {
  const dialog = useRef<HTMLDialogElement>(null);
  const way = useSignal<Way>(last);
  const tabs = useRef(new Map<Way, HTMLButtonElement>());
  useEffect(() => dialog.current?.showModal(), []);
  const choose = (name: Way): void => {
    last = name;
    way.value = name;
  };
  const onKey = (event: KeyboardEvent): void => {
    const by = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (by === undefined) return;
    event.preventDefault();
    const at = WAYS.findIndex(([name]) => name === way.value);
    const [next] = WAYS[(at + by + WAYS.length) % WAYS.length] as (typeof WAYS)[number];
    choose(next);
    tabs.current.get(next)?.focus();
  };
  return (
    <dialog
      ref={dialog}
      class="question code"
      aria-labelledby="code-title"
      data-dialog="code"
      onClose={() => {
        shownCode.value = null;
      }}
    >
      <div class="code-head">
        <h2 id="code-title">What this page shows, as code</h2>
        <button type="button" data-action="close-code" onClick={() => dialog.current?.close()}>
          Close
        </button>
      </div>
      <div class="tabs" role="tablist" aria-labelledby="code-title" onKeyDown={onKey}>
        {WAYS.map(([name, title]) => (
          <button
            key={name}
            ref={(tab) => {
              if (tab) tabs.current.set(name, tab);
            }}
            type="button"
            role="tab"
            id={`code-tab-${name}`}
            aria-controls={`code-${name}`}
            aria-selected={way.value === name}
            tabIndex={way.value === name ? 0 : -1}
            onClick={() => choose(name)}
          >
            {title}
          </button>
        ))}
      </div>
      {WAYS.map(([name, title]) => (
        <div
          key={name}
          id={`code-${name}`}
          role="tabpanel"
          aria-labelledby={`code-tab-${name}`}
          data-code={name}
          hidden={way.value !== name}
        >
          <OneWay part={code[name]} title={title} />
        </div>
      ))}
    </dialog>
  );
}

function OneWay({ part: { text, needs, lacks }, title }: { part: Part; title: string }) {
  const place = useRef<HTMLPreElement>(null);
  const told = useSignal('');
  const copy = async (): Promise<void> => {
    // The same words twice would not be said again.
    told.value = '';
    try {
      await navigator.clipboard.writeText(text);
      told.value = 'Copied';
    } catch {
      if (place.current) getSelection()?.selectAllChildren(place.current);
      told.value = 'The browser does not let pages copy. The code is selected: copy it with Ctrl+C.';
    }
  };
  return (
    <>
      {needs && <p data-needs>{needs}</p>}
      {lacks.length > 0 && (
        <ul class="lacks" aria-label="Remarks on this code">
          {lacks.map((lack) => (
            <li key={lack}>{lack}</li>
          ))}
        </ul>
      )}
      {text && (
        <>
          <pre ref={place} tabIndex={0} role="region" aria-label={`${title}, scrollable`}>
            <code>{text}</code>
          </pre>
          <div class="row">
            <button type="button" class="primary" data-action="copy-code" onClick={() => void copy()}>
              Copy
            </button>
            <span role="status">{told.value}</span>
          </div>
        </>
      )}
    </>
  );
}
