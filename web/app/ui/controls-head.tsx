/** What stands above the controls of every page. */
import { showHelp } from '../state/settings.ts';
import { CheckField } from './field.tsx';

export function ControlsHead({ but = '', onDefaults }: { but?: string; onDefaults(): void }) {
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
    </div>
  );
}
