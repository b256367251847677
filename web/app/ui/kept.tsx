/** Says what the browser keeps of the site, and removes it. */
import { useState } from 'preact/hooks';
import { byteSize } from '../../plots/format.ts';
import { type Kept, kept, mayKeep, removeKept, setMayKeep } from '../offline/kept.ts';
import { announce } from '../state/announce.ts';
import { About } from './about.tsx';

export function KeptNote() {
  const [list, setList] = useState<Kept[] | null>(null);
  const look = async (): Promise<void> => setList(await kept());
  const choose = async (may: boolean): Promise<void> => {
    setMayKeep(may);
    if (!may) {
      await removeKept();
      announce('What was kept is removed.');
    }
    await look();
  };
  return (
    <About title="Offline use" onOpen={() => void look()}>
      <p>
        The browser keeps this site, so that it starts at once and works without a connection. Networks, and other large
        files, are kept when they were used for the first time. Your own files are never kept.
      </p>
      {list && (
        <p data-kept={list.reduce((sum, { bytes }) => sum + bytes, 0)}>
          {list.length
            ? `Kept now: ${list.map(({ title, files, bytes }) => `${title}: ${files === 1 ? '1 file' : `${files} files`}, ${byteSize(bytes)}`).join('; ')}.`
            : mayKeep.value
              ? 'Nothing is kept yet. That begins some seconds after a page is loaded, where the browser allows it.'
              : 'Nothing is kept.'}
        </p>
      )}
      <p>
        <label>
          <input
            type="checkbox"
            name="keep"
            checked={mayKeep.value}
            onChange={(event) => void choose(event.currentTarget.checked)}
          />{' '}
          Keep the site for offline use, from the next visit on. Without the tick, all that is kept is removed at once.
        </label>
      </p>
    </About>
  );
}
