/** Splits `total` units into consecutive, nearly equal ranges, at most so many. */
export function split(total: number, most: number): { first: number; count: number }[] {
  const pieces = Math.min(total, most);
  const start = (piece: number): number => Math.floor((piece * total) / pieces);
  return Array.from({ length: pieces }, (_, piece) => ({
    first: start(piece),
    count: start(piece + 1) - start(piece),
  }));
}
