/** Pieces a worker gets of a job, so that progress moves and slow pieces even out. */
const PIECES_A_WORKER = 8;

/** Splits `total` units into consecutive, nearly equal ranges. */
export function split(total: number, workers: number): { first: number; count: number }[] {
  const pieces = Math.min(total, workers * PIECES_A_WORKER);
  const start = (piece: number): number => Math.floor((piece * total) / pieces);
  return Array.from({ length: pieces }, (_, piece) => ({
    first: start(piece),
    count: start(piece + 1) - start(piece),
  }));
}
