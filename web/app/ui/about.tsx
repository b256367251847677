import type { ComponentChildren } from 'preact';

export function About({
  title,
  onOpen,
  children,
}: {
  title: string;
  onOpen?: () => void;
  children: ComponentChildren;
}) {
  return (
    <details
      class="panel about"
      onToggle={(event) => {
        if (event.currentTarget.open) onOpen?.();
      }}
    >
      <summary>
        <h3>{title}</h3>
      </summary>
      <div class="prose">{children}</div>
    </details>
  );
}
