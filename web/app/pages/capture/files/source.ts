/** The open capture on the workers. */
import type { AngleOptions, Cell, CellExplanation, ChainOptions, Estimate, FrameResult } from 'boresight';
import type { JobOptions } from 'boresight/worker';
import type { Loaded } from './files.ts';

/** One frame, or all of them combined. */
export function runChain(
  { kept }: Loaded,
  chain: ChainOptions,
  frame: number | 'all',
  job: JobOptions,
): Promise<FrameResult> {
  return frame === 'all' ? kept.combineFrames(chain, job) : kept.processFrame(frame, chain, job);
}

/** Angles in one cell: from one snapshot, or one of each frame. */
export function estimateCell(
  { kept }: Loaded,
  chain: ChainOptions,
  frame: number | 'all',
  cell: Cell,
  angle: AngleOptions,
  job: JobOptions,
): Promise<Estimate> {
  return kept.cellSpectrum(frame === 'all' ? cell : { ...cell, frame }, angle, chain, job);
}

/** Why a cell is a detection or none. */
export function explainCell(
  { kept }: Loaded,
  chain: ChainOptions,
  frame: number | 'all',
  cell: Cell,
  job: JobOptions,
): Promise<CellExplanation> {
  return kept.explainCell(frame === 'all' ? cell : { ...cell, frame }, chain, job);
}
