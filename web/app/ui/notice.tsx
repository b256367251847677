/** Something that went otherwise than one may think; it stays until it is put away. */
import type { ComponentChildren } from 'preact';

export function Notice({
  name,
  onClose,
  children,
}: {
  /** For tests. */
  name: string;
  onClose(): void;
  children: ComponentChildren;
}) {
  return (
    <div class="notice closable" role="status" data-notice={name}>
      <p>{children}</p>
      <button type="button" aria-label="Put this message away" onClick={onClose}>
        {'×'}
      </button>
    </div>
  );
}
