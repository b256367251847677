/** The board's own objects beside our detections. */
import type { BoardObject, Detection } from 'boresight';

export interface Comparison {
  row?: Detection;
  board?: BoardObject;
}

/**
 * Rows with the board's objects nearest in range, one to one, none further off than the gate; then objects left over.
 */
export function compare(rows: readonly Detection[], objects: readonly BoardObject[], gateM: number): Comparison[] {
  const pairs = rows.flatMap((row, i) =>
    objects.map((object, j) => ({ i, j, apart: Math.abs(row.rangeM - object.rangeM), power: row.powerDb })),
  );
  // The strongest of ours in the gate is the board's one: side lobes lie beside it.
  pairs.sort((a, b) => b.power - a.power || a.apart - b.apart);
  const boardOf = new Map<number, number>();
  const taken = new Set<number>();
  for (const { i, j, apart } of pairs) {
    if (apart > gateM || boardOf.has(i) || taken.has(j)) continue;
    boardOf.set(i, j);
    taken.add(j);
  }
  return [
    ...rows.map((row, i): Comparison => {
      const board = objects[boardOf.get(i) ?? -1];
      return board ? { row, board } : { row };
    }),
    ...objects.filter((_, j) => !taken.has(j)).map((board): Comparison => ({ board })),
  ];
}
