/** Folders that survive a power cut: their entries are on disk only after the folder holding them was synchronised. */
import { closeSync, fsyncSync, mkdirSync, openSync } from 'node:fs';
import { dirname, resolve } from 'node:path';

/** Makes a folder with the ones above it, where they are missing. @param {string} path */
export function makeFolder(path) {
  const first = mkdirSync(path, { recursive: true });
  // Windows opens no folders.
  if (first === undefined || process.platform === 'win32') return;
  const top = dirname(resolve(first));
  for (let folder = dirname(resolve(path)); folder.length >= top.length; folder = dirname(folder)) {
    const opened = openSync(folder, 'r');
    try {
      fsyncSync(opened);
    } finally {
      closeSync(opened);
    }
    if (folder === dirname(folder)) break;
  }
}
