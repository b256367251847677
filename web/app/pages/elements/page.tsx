import { useLayoutEffect, useRef } from 'preact/hooks';
import { define, usePool } from '../../../elements/index.ts';
import { pool } from '../../data.ts';
import { useAddress } from '../../state/address.ts';
import { theme } from '../../state/theme.ts';
import { MainColumn } from '../../ui/main-column.tsx';
import { CodePanel } from './code-panel.tsx';
import { Form } from './form.tsx';
import { Reference } from './reference.tsx';
import { type Made, made, problem, settings, start, working } from './run.ts';
import { captionOf, elementsCodec, elementsState, sample, told } from './state.ts';

define();

/** The element, made once and set anew. */
function Shown({ made: { sample, properties } }: { made: Made }) {
  const host = useRef<HTMLDivElement>(null);
  const element = useRef<HTMLElement | null>(null);
  const given = settings.value;
  const colours = given.theme && given.theme !== 'auto' ? given.theme : theme.value;
  useLayoutEffect(() => {
    const made = document.createElement(sample.tag);
    element.current = made;
    host.current?.replaceChildren(made);
    return () => made.remove();
  }, [sample]);
  useLayoutEffect(() => {
    const shown = element.current;
    if (!shown) return;
    const wanted: Record<string, string> = { heading: sample.title, ...given, theme: colours };
    for (const name of shown.getAttributeNames()) if (!(name in wanted)) shown.removeAttribute(name);
    for (const [name, value] of Object.entries(wanted)) {
      if (shown.getAttribute(name) !== value) shown.setAttribute(name, value);
    }
  }, [sample, given, colours]);
  useLayoutEffect(() => void Object.assign(element.current ?? {}, properties), [properties]);
  return <div ref={host} class="gallery-element" />;
}

export function ElementsPage() {
  useAddress('elements', {
    codec: elementsCodec,
    restore: (params) => {
      elementsState.value = elementsCodec.read(params);
    },
    start: () => {
      usePool(pool());
      return start();
    },
    write: () => elementsCodec.write(elementsState.value),
    caption: () => captionOf(elementsState.peek()),
  });
  const shown = made.value;
  const wrong = problem.value;
  return (
    <div class="page">
      <Form />
      <MainColumn busy={working.value}>
        {wrong && (
          <p class="alert" role="alert" data-error={wrong.code}>
            {wrong.message} <code>{wrong.code}</code>
          </p>
        )}
        <section class="panel" aria-labelledby="element-shown" data-element={shown?.sample.tag}>
          <div class="panel-head">
            <h3 id="element-shown">
              <code>{`<${sample.value.tag}>`}</code>
            </h3>
            <span class="muted detail">
              {told.value.description} Shown with {sample.value.recording ? 'a bundled recording' : 'simulated data'}.
            </span>
          </div>
          {shown && shown.sample === sample.value ? (
            <Shown key={shown.sample.tag} made={shown} />
          ) : (
            <p class="loading">Making its data</p>
          )}
        </section>
        <CodePanel />
        <Reference />
      </MainColumn>
    </div>
  );
}
