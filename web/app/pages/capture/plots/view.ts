/** What the plots and the table need beside a result: the chosen cell and the limits of the colours. */
import type { Cell, Detection, FrameResult } from 'boresight';
import { limitsBelow } from '../../../../plots/heat.ts';

/** The chosen cell, or the strongest detection's, kept within the map. */
export function shownCell(view: FrameResult, cell: Cell | null): Cell {
  const strongest = view.detections.reduce<Detection | null>(
    (best, row) => (best && best.powerDb >= row.powerDb ? best : row),
    null,
  );
  const wanted =
    cell ??
    (strongest
      ? { rangeBin: strongest.rangeBin, dopplerBin: strongest.dopplerBin }
      : { rangeBin: 0, dopplerBin: Math.floor(view.rateMps.length / 2) });
  return {
    rangeBin: Math.min(wanted.rangeBin, view.rangeM.length - 1),
    dopplerBin: Math.min(wanted.dopplerBin, view.rateMps.length - 1),
  };
}

/** Limits of the colours: from the strongest of all powers down. */
export function colorLimits(powersDb: Float32Array, spanDb: number): [number, number] {
  let top = Number.NEGATIVE_INFINITY;
  for (const power of powersDb) if (power > top) top = power;
  return limitsBelow(top, spanDb);
}
