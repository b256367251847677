/** The controls: a column where there is room, else behind a button. */
import { useSignal } from '@preact/signals';
import type { ComponentChildren } from 'preact';
import { useId } from 'preact/hooks';

export function Sidebar({ label, button, children }: { label: string; button: string; children: ComponentChildren }) {
  const open = useSignal(false);
  const id = useId();
  return (
    <div class={`sidebar${open.value ? ' open' : ''}`}>
      <button
        type="button"
        class="sidebar-toggle"
        aria-expanded={open.value}
        aria-controls={id}
        onClick={() => {
          open.value = !open.value;
        }}
      >
        {open.value ? `Hide ${button}` : `Show ${button}`}
      </button>
      <form id={id} class="controls" aria-label={label} onSubmit={(event) => event.preventDefault()}>
        {children}
      </form>
    </div>
  );
}
