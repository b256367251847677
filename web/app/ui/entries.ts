/** Files out of what was dropped: folders are looked through. */

export interface NamedFile {
  name: string;
  file: File;
}

/** More files than a folder of one drive holds. */
const MOST_FILES = 20_000;

/** Must be called while the drop is handled; the browser forgets what was dropped after that. */
export function droppedFiles(transfer: DataTransfer): Promise<NamedFile[]> {
  const entries: FileSystemEntry[] = [];
  const files: NamedFile[] = [];
  for (const item of transfer.items) {
    if (item.kind !== 'file') continue;
    const entry = item.webkitGetAsEntry();
    const file = entry?.isDirectory ? null : item.getAsFile();
    if (file) files.push({ name: file.name, file });
    else if (entry) entries.push(entry);
  }
  return entries.length ? walk(entries).then((found) => [...files, ...found]) : Promise.resolve(files);
}

/** What a file or folder picker gave. */
export function pickedFiles(list: FileList | null): NamedFile[] {
  return [...(list ?? [])].map((file) => ({ name: file.webkitRelativePath || file.name, file }));
}

async function walk(start: readonly FileSystemEntry[]): Promise<NamedFile[]> {
  const found: NamedFile[] = [];
  const waiting = [...start];
  for (let entry = waiting.shift(); entry; entry = waiting.shift()) {
    if (found.length + waiting.length > MOST_FILES) break;
    if (entry.isFile) {
      const file = await new Promise<File>((resolve, reject) => (entry as FileSystemFileEntry).file(resolve, reject));
      found.push({ name: entry.fullPath.replace(/^\//, ''), file });
    } else if (entry.isDirectory) {
      const reader = (entry as FileSystemDirectoryEntry).createReader();
      // A reader gives its entries in batches, and none at the end.
      for (;;) {
        const batch = await new Promise<FileSystemEntry[]>((resolve, reject) => reader.readEntries(resolve, reject));
        if (batch.length === 0) break;
        waiting.push(...batch);
      }
    }
  }
  return found;
}
