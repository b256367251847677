/** What a page shows, beside its controls. */
import type { ComponentChildren } from 'preact';

export function MainColumn({ busy, children }: { busy?: boolean; children: ComponentChildren }) {
  return (
    <div id="plots" class="main-column" tabIndex={-1} aria-busy={busy}>
      <h2 class="visually-hidden">Plots and tables</h2>
      {children}
    </div>
  );
}
