/** The code of what is shown, to copy. */
import { signal } from '@preact/signals';
import { copier } from '../../ui/copy.ts';
import { codeOf, KINDS, type Kind } from './code.ts';
import { options, settings } from './run.ts';
import { sample } from './state.ts';

const LABELS: Record<Kind, string> = { html: 'HTML', react: 'React', notebook: 'Notebook' };
const NEEDS: Record<Kind, string> = {
  html: 'Needs the package boresight and a bundler, or an import map.',
  react: 'Needs the packages boresight and react 19, and a bundler.',
  notebook: 'Needs the Python package boresight-widget. The data are yours: here NumPy makes some.',
};

const kind = signal<Kind>('html');
const codeCopier = copier('The code', 'select the code');

export function CodePanel() {
  const chosen = kind.value;
  const shown = sample.value;
  const text = codeOf(chosen, { sample: shown, options: options.value, settings: settings.value });
  const files =
    shown.recording && chosen !== 'notebook'
      ? ` Its files are served beside it: ${shown.recording.files.join(', ')}.`
      : '';
  return (
    <section class="panel code-panel" aria-label="Code">
      <div class="panel-head">
        <h3>Code</h3>
        <div class="segments" role="group" aria-label="Code for">
          {KINDS.map((one) => (
            <button
              key={one}
              type="button"
              aria-pressed={one === chosen}
              data-kind={one}
              onClick={() => {
                kind.value = one;
              }}
            >
              {LABELS[one]}
            </button>
          ))}
        </div>
        <div class="tools">
          <button type="button" data-action="copy-code" onClick={() => void codeCopier.copy(text)}>
            {codeCopier.told.value ?? 'Copy'}
          </button>
        </div>
      </div>
      <pre tabIndex={0} role="region" aria-label={`Code for ${LABELS[chosen]}`}>
        <code data-code={chosen}>{text}</code>
      </pre>
      <p class="muted">
        {NEEDS[chosen]}
        {files}
      </p>
    </section>
  );
}
