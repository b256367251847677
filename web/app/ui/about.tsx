import type { ComponentChildren } from 'preact';

export function About({ title, children }: { title: string; children: ComponentChildren }) {
  return (
    <details class="panel about">
      <summary>
        <h3>{title}</h3>
      </summary>
      <div class="prose">{children}</div>
    </details>
  );
}
