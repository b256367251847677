/** The controls: a column where there is room, else a sheet at the foot of the screen, under what they change. */
import { useSignal } from '@preact/signals';
import type { ComponentChildren } from 'preact';
import { useEffect, useId, useRef } from 'preact/hooks';

export function Sidebar({ label, button, children }: { label: string; button: string; children: ComponentChildren }) {
  const open = useSignal(false);
  const id = useId();
  const toggle = useRef<HTMLButtonElement>(null);
  const whole = useRef<HTMLDivElement>(null);
  useEffect(() => {
    const close = (event: KeyboardEvent): void => {
      if (event.key !== 'Escape' || event.defaultPrevented || !open.value) return;
      open.value = false;
      toggle.current?.focus();
    };
    const element = whole.current;
    element?.addEventListener('keydown', close);
    return () => element?.removeEventListener('keydown', close);
  }, []);
  return (
    <div ref={whole} class={`sidebar${open.value ? ' open' : ''}`}>
      <button
        ref={toggle}
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
      <h2 class="visually-hidden">{label}</h2>
      <form id={id} class="controls" aria-label={label} onSubmit={(event) => event.preventDefault()}>
        {children}
      </form>
    </div>
  );
}
