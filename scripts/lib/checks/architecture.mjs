// The diagram of docs/architecture.md: the dependencies between the crates, without those that others imply.
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { root } from '../paths.mjs';
import { output } from '../run.mjs';
import { layers, short, workspaceGraph } from './dependency-rules.mjs';

export const page = 'docs/architecture.md';
const PLACE = /(<!-- diagram -->\n)[\s\S]*?(<!-- end of diagram -->)/;

/** Crate -> crates that it depends on directly and by no other of these. */
export function arrows(graph) {
  const direct = new Map(
    [...graph].map(([name, dependencies]) => [
      name,
      dependencies.filter(({ ours, kind }) => ours && kind === 'normal').map((one) => short(one.name)),
    ]),
  );
  const reached = (name) => new Set(direct.get(name).flatMap((on) => [on, ...reached(on)]));
  const implied = (name, on) => direct.get(name).some((other) => other !== on && reached(other).has(on));
  return new Map([...direct].map(([name, all]) => [name, all.filter((on) => !implied(name, on)).sort()]));
}

/** The page with its diagram. */
export function architecturePage() {
  const text = output('cargo', ['metadata', '--format-version', '1', '--no-deps']);
  if (text === null) throw new Error('cargo metadata failed');
  const drawn = arrows(workspaceGraph(JSON.parse(text)));
  const lines = layers
    .toReversed()
    .flat()
    .flatMap((name) => (drawn.get(name).length ? [`  ${name} --> ${drawn.get(name).join(' & ')}`] : []));
  const diagram = ['', '```mermaid', 'graph TD', ...lines, '```', '', ''].join('\n');
  return [page, readFileSync(join(root, page), 'utf8').replace(PLACE, (_, begin, end) => `${begin}${diagram}${end}`)];
}
