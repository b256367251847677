/** Buttons that save and open a session, and the question before one replaces the user's own files. */

import { useEffect, useRef } from 'preact/hooks';
import { FileButton } from '../ui/file-button.tsx';
import { answer, asking, openSession, saveSession, working } from './session.ts';

export function SessionBar({ ready }: { ready: boolean }) {
  const doing = working.value;
  return (
    <div class="session-bar" role="group" aria-label="Session">
      <button
        type="button"
        data-action="save-session"
        disabled={!ready || doing !== null}
        title="Save the settings of all pages and your own files that are open as one file, on this machine"
        onClick={() => void saveSession()}
      >
        {doing === 'saving' ? 'Saving' : 'Save'}
        <span class="wide-only"> session</span>
      </button>
      <FileButton
        label="Session file"
        accept=".boresight"
        name="session"
        action="open-session"
        disabled={!ready || doing !== null}
        title="Open a saved session (.boresight); or drop it anywhere on the page"
        onFiles={([first]) => first && void openSession(first.file)}
      >
        {doing === 'opening' ? 'Opening' : 'Open'}
        <span class="wide-only"> session</span>
      </FileButton>
      <Question />
    </div>
  );
}

/** More names would push the buttons off a phone. */
const MOST_NAMES = 5;

function Question() {
  const dialog = useRef<HTMLDialogElement>(null);
  const asked = asking.value;
  useEffect(() => {
    if (asked) dialog.current?.showModal();
    else dialog.current?.close();
  }, [asked]);
  const names = asked?.replaced ?? [];
  const rest = names.length - MOST_NAMES;
  return (
    <dialog ref={dialog} class="question" aria-labelledby="session-question" onCancel={() => answer(false)}>
      <h2 id="session-question">Replace your own files?</h2>
      <p>
        {asked?.name} closes {names.slice(0, MOST_NAMES).join(', ')}
        {rest > 0 ? ` and ${rest} more` : ''}, which must then be opened again. Settings can be taken back by Undo.
      </p>
      <div class="row">
        <button type="button" class="primary" data-action="replace" onClick={() => answer(true)}>
          Open the session
        </button>
        <button type="button" data-action="keep" onClick={() => answer(false)}>
          Keep what is open
        </button>
      </div>
    </dialog>
  );
}
