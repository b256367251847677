/** Shipped networks, and what the page Networks shows of a network that it tried. */
import { existsSync, readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { root } from '../../../scripts/lib/paths.mjs';
import { values } from './demo.mjs';

const folders = ['models', 'research/models']
  .map((folder) => join(root, folder))
  .filter((folder) => existsSync(folder));
export const models = folders
  .flatMap((folder) => readdirSync(folder))
  .filter((name) => name.endsWith('.json'))
  .map((name) => name.replace('.json', ''))
  .sort();
export const file = (name) =>
  readFileSync(folders.map((folder) => join(folder, name)).find((path) => existsSync(path)));
export const card = (name) => JSON.parse(file(`${name}.json`));

/** A network is fetched, its module compiled in each worker: on a busy machine that takes its time. */
export const patient = { timeout: 60_000 };
export const tried = (page) => page.waitForSelector('[data-attempt] [data-table="attempt"]', patient);
export const cell = (page, row, field) =>
  values(page, `[data-table="attempt"] [data-row="${row}"] [data-field="${field}"]`);
