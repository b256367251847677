import { existsSync, mkdirSync, readdirSync, renameSync, rmSync } from 'node:fs';
import { dirname, join, relative, sep } from 'node:path';

/** Moves a finished build to where it is served, file by file; what names other files comes after these. */
export function publish(built, served) {
  const filesOf = (folder) =>
    existsSync(folder)
      ? readdirSync(folder, { recursive: true, withFileTypes: true })
          .filter((entry) => entry.isFile())
          .map((entry) => relative(folder, join(entry.parentPath, entry.name)))
      : [];
  const files = filesOf(built);
  const isAsset = (name) => name.startsWith(`assets${sep}`);
  for (const name of [...files.filter(isAsset), ...files.filter((name) => !isAsset(name))]) {
    mkdirSync(dirname(join(served, name)), { recursive: true });
    renameSync(join(built, name), join(served, name));
  }
  const published = new Set(files);
  for (const name of filesOf(served)) if (!published.has(name)) rmSync(join(served, name));
  rmSync(built, { recursive: true });
}
