/** Text while it is typed, apart from the value that it stands for. */
import { useLayoutEffect, useRef, useState } from 'preact/hooks';

export interface Draft {
  /** What was typed, as typed; null where the value itself is shown. */
  text: string | null;
  /** Takes what was typed; `send` may change the value. */
  type(text: string, send: () => void): void;
  /** Shows the value again. */
  drop(): void;
}

/** A draft lives through the changes of `value` that it caused itself, and ends with any other. */
export function useDraft(value: string, onChangeElsewhere?: () => void): Draft {
  const [text, setText] = useState<string | null>(null);
  const sent = useRef(false);
  useLayoutEffect(() => {
    if (sent.current) return;
    setText(null);
    onChangeElsewhere?.();
  }, [value]);
  useLayoutEffect(() => {
    sent.current = false;
  });
  return {
    text,
    type: (next, send) => {
      setText(next);
      sent.current = true;
      send();
    },
    drop: () => setText(null),
  };
}
