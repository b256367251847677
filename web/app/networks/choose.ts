/** Which network a method of a page uses, and why it may have none. */
import type { Method } from 'boresight';
import { models } from './load.ts';
import { arrayProblem, elementsOf, type Geometry, type Model, targetsOf } from './models.ts';

/**
 * Networks of a method that fit all arrays, best first: for the number of targets, for this array rather than any, then the
 * quickest to load.
 */
export function fitting(method: Method | 'counting', geometries: readonly Geometry[], sources: number | null): Model[] {
  const off = (model: Model): number => Math.abs((targetsOf(model.card) ?? sources ?? 2) - (sources ?? 2));
  const forAny = ({ card }: Model): number => Number(elementsOf(card) === null);
  return models.value
    .filter(({ card }) => card.network === method && geometries.every((geometry) => !arrayProblem(card, geometry)))
    .sort((a, b) => off(a) - off(b) || forAny(a) - forAny(b) || (a.card.parameters ?? 0) - (b.card.parameters ?? 0));
}

/** The one used: one that the link names, else the best. */
export function modelFor(
  method: Method,
  geometries: readonly Geometry[],
  sources: number | null,
  named: string,
): Model | undefined {
  const all = fitting(method, geometries, sources);
  const names = named.split(',');
  return all.find(({ name }) => names.includes(name)) ?? all[0];
}

/** Why no network of the method works on snapshots of these arrays, in words; null where one does. */
export function whyNoNetwork(method: Method, geometries: readonly Geometry[]): string | null {
  if (method === 'cnn3d')
    return 'takes a region of range bins and chirps, which one cell is not: try it on the page Networks';
  if (fitting(method, geometries, null).length) return null;
  const model = models.value.find(({ card }) => card.network === method);
  if (!model) return 'has no network here';
  return geometries.map((geometry) => arrayProblem(model.card, geometry)).find((problem) => problem !== null) ?? null;
}

/** The names in a link with `name` in place of the others of its method. */
export function choosing(named: string, model: Model): string {
  const kinds = new Map(models.value.map(({ name, card }) => [name, card.network]));
  return [
    ...named.split(',').filter((name) => kinds.has(name) && kinds.get(name) !== model.card.network),
    model.name,
  ].join(',');
}
