/** Whose a bundled recording is, and on what terms. */
import { useSignal } from '@preact/signals';

export function Licence({ address, summary, remark }: { address: string; summary: string; remark: string }) {
  const text = useSignal<string | null>(null);
  const load = async (): Promise<void> => {
    const response = await fetch(address);
    text.value = response.ok
      ? await response.text()
      : `The licence could not be loaded: the server answered ${response.status}.`;
  };
  return (
    <details class="licence small" onToggle={(event) => event.currentTarget.open && text.value === null && void load()}>
      <summary>{summary}</summary>
      <p class="muted">{remark}</p>
      <pre tabIndex={0} role="region" aria-label="Licence of the recording">
        {text.value ?? ''}
      </pre>
    </details>
  );
}
