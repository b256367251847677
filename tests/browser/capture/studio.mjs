/** The JSON of mmWave Studio that says what recordings/awr1642/profile.cfg does. */
import { readFileSync } from 'node:fs';

const read = (name) => JSON.parse(readFileSync(new URL(`../../golden/mmwave-studio/${name}`, import.meta.url)));

export const studio = () => read('awr1642.mmwave.json');
export const setup = read('awr1642.setup.json');
export const json = (name, value) => ({
  name,
  bytes: Buffer.from(typeof value === 'string' ? value : JSON.stringify(value)),
});
