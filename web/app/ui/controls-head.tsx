/** What stands above the controls of every page. */
import { useEffect } from 'preact/hooks';
import { type CodeSource, codeProblem, showCode } from '../code/shown.tsx';
import { undo } from '../state/address.ts';
import { canRedo, canUndo } from '../state/history.ts';
import { link } from '../state/route.ts';
import { showHelp } from '../state/settings.ts';
import { copier } from './copy.ts';
import { CheckField } from './field.tsx';

const linkCopier = copier('The link', 'the link is in the address bar');

/** A text being typed has an undo of its own. */
const typing = (target: EventTarget | null): boolean =>
  target instanceof HTMLInputElement && target.type === 'text' && document.activeElement === target;

interface Head {
  /** What defaults leave as it is. */
  but?: string;
  /** Absent where the page itself shows it. */
  code?: CodeSource;
  onDefaults(): void;
}

export function ControlsHead({ but = '', code, onDefaults }: Head) {
  useEffect(() => {
    const key = (event: KeyboardEvent): void => {
      if (!(event.ctrlKey || event.metaKey) || event.altKey || typing(event.target)) return;
      const name = event.key.toLowerCase();
      if (name !== 'z' && name !== 'y') return;
      event.preventDefault();
      undo(name === 'y' || event.shiftKey ? 1 : -1);
    };
    addEventListener('keydown', key);
    return () => removeEventListener('keydown', key);
  }, []);
  return (
    <div class="controls-head">
      <CheckField
        label="Explain the controls"
        value={showHelp.value}
        help="Shows a sentence below each control."
        onChange={(on) => {
          showHelp.value = on;
        }}
      />
      <button
        type="button"
        class="plain"
        title={`Back to the settings a fresh visit starts with${but}`}
        onClick={onDefaults}
      >
        Defaults
      </button>
      <div class="row">
        <button
          type="button"
          data-action="undo"
          aria-label="Undo"
          title="Take back the last change of settings (Ctrl+Z)"
          disabled={!canUndo.value}
          onClick={() => undo(-1)}
        >
          {'↶'}
        </button>
        <button
          type="button"
          data-action="redo"
          aria-label="Redo"
          title="Make it again (Ctrl+Shift+Z)"
          disabled={!canRedo.value}
          onClick={() => undo(1)}
        >
          {'↷'}
        </button>
        <button
          type="button"
          data-action="copy-link"
          title="Copy a link to this page with these settings; files of your own are not in it"
          onClick={() => void linkCopier.copy(link())}
        >
          {linkCopier.told.value ?? 'Copy link'}
        </button>
        {code && (
          <button
            type="button"
            data-action="show-code"
            title="What this page shows as a script for Node and as commands, which give the same numbers"
            onClick={() => void showCode(code)}
          >
            {codeProblem.value ? 'Not loaded' : 'Copy as code'}
          </button>
        )}
      </div>
    </div>
  );
}
