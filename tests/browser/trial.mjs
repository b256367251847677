/** Shipped networks, and what the page Networks shows of a network that it tried. */
import { readdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { root } from '../../scripts/lib/paths.mjs';
import { values } from './demo.mjs';

export const models = readdirSync(join(root, 'models'))
  .filter((name) => name.endsWith('.json'))
  .map((name) => name.replace('.json', ''));
export const file = (name) => readFileSync(join(root, 'models', name));
export const card = (name) => JSON.parse(file(`${name}.json`));

/** A network is fetched, its module compiled in each worker: on a busy machine that takes its time. */
export const patient = { timeout: 60_000 };
export const tried = (page) => page.waitForSelector('[data-attempt] [data-table="attempt"]', patient);
export const cell = (page, row, field) =>
  values(page, `[data-table="attempt"] [data-row="${row}"] [data-field="${field}"]`);
