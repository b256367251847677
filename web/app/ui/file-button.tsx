import type { ComponentChildren } from 'preact';
import { useRef } from 'preact/hooks';
import { pickedFiles } from './entries.ts';

type Picked = ReturnType<typeof pickedFiles>;

interface FileButtonProps {
  children: ComponentChildren;
  /** What is chosen, in words for those who do not see the button. */
  label: string;
  /** Names or endings of the files, as `accept` has them. */
  accept?: string;
  multiple?: boolean;
  /** A folder, with all that is in it. */
  folder?: boolean;
  /** Name of the field. */
  name?: string;
  /** What tests and styles know the button by. */
  action?: string;
  title?: string;
  disabled?: boolean;
  /** Takes what was chosen, never nothing. */
  onFiles: (files: Picked) => void;
}

/** A button that lets one choose files of this machine; the same may be chosen again. */
export function FileButton(props: FileButtonProps) {
  const { children, label, accept, multiple, folder, name, action, title, disabled, onFiles } = props;
  const input = useRef<HTMLInputElement>(null);
  return (
    <>
      <button
        type="button"
        data-action={action}
        title={title}
        disabled={disabled}
        onClick={() => input.current?.click()}
      >
        {children}
      </button>
      <input
        ref={input}
        type="file"
        hidden
        multiple={multiple}
        accept={accept}
        name={name}
        aria-label={label}
        {...(folder ? { webkitdirectory: true } : {})}
        onChange={(event) => {
          const files = pickedFiles(event.currentTarget.files);
          event.currentTarget.value = '';
          if (files.length > 0) onFiles(files);
        }}
      />
    </>
  );
}
