/** How far work is, how long it may still take, and what ends it or takes it up again. */
import type { ComponentChildren } from 'preact';
import { useRef } from 'preact/hooks';

/** Work younger than this says nothing of how long it takes, ms. */
const SOON_MS = 1000;
/** Less is not worth saying, s. */
const SHORT_S = 3;

/** Time left in words, from how fast a share of the work grew since it was first seen; null where that is not known. */
function useTimeLeft(what: string, share: number | null): string | null {
  const begun = useRef({ what: '', at: 0, share: 0 });
  const now = performance.now();
  if (begun.current.what !== what || (share ?? 0) < begun.current.share) {
    begun.current = { what, at: now, share: share ?? 0 };
  }
  const { at, share: from } = begun.current;
  if (share === null || now - at < SOON_MS || share <= from) return null;
  const left = ((now - at) / 1000) * ((1 - share) / (share - from));
  if (left < SHORT_S) return null;
  return left < 90 ? `about ${Math.ceil(left / 5) * 5} s left` : `about ${Math.ceil(left / 60)} min left`;
}

export function ProgressLine({
  what,
  text = what,
  share,
  of = { what, share },
  mark = 'data-progress',
  cancel,
  onCancel,
  children,
}: {
  /** What is done, for a screen reader. */
  what: string;
  /** What is said beside the bar. */
  text?: string;
  /** Of the whole work; null where that is not known. */
  share: number | null;
  /** The part of the work whose time left is told, where the whole goes at no even pace. */
  of?: { what: string; share: number | null };
  mark?: 'data-progress' | 'data-opening';
  /** What the button does, for tests. */
  cancel: string;
  onCancel(): void;
  children?: ComponentChildren;
}) {
  const left = useTimeLeft(of.what, of.share);
  return (
    <div class="progress-line" {...{ [mark]: true }}>
      <progress max={1} value={share ?? undefined} aria-label={what} />
      <span>
        {text}
        {left && <span data-left>{`, ${left}`}</span>}
      </span>
      <button type="button" data-action={cancel} onClick={onCancel}>
        Cancel
      </button>
      {children}
    </div>
  );
}

/** In the place of the bar once work was cancelled. */
export function Stopped({
  text,
  mark = 'data-cancelled',
  action,
  label,
  onResume,
}: {
  text: string;
  mark?: 'data-cancelled' | 'data-interrupted';
  action: string;
  label: string;
  onResume(): void;
}) {
  return (
    <div class="progress-line" {...{ [mark]: true }}>
      <span class="muted">{text}</span>
      <button type="button" data-action={action} onClick={onResume}>
        {label}
      </button>
    </div>
  );
}
