/** The open capture on the workers, which get no more of it than a job needs. */
import type { AngleOptions, Cell, ChainOptions, Estimate, FrameResult } from 'boresight';
import type { JobOptions } from 'boresight/worker';
import { pool } from '../../data.ts';
import type { Loaded } from './files.ts';

/** One frame, or all of them combined. */
export async function runChain(
  capture: Loaded,
  chain: ChainOptions,
  frame: number | 'all',
  job: JobOptions,
): Promise<FrameResult> {
  const { bin, cfg } = capture;
  if (frame === 'all') return pool().combineFrames(bin, cfg, chain, job);
  const result = await pool().processFrame(bytesOf(capture, frame), cfg, 0, chain, job);
  return { ...result, frame, detections: result.detections.map((detection) => ({ ...detection, frame })) };
}

/** Angles in one cell: from one snapshot, or one of each frame. */
export function estimateCell(
  capture: Loaded,
  chain: ChainOptions,
  frame: number | 'all',
  cell: Cell,
  angle: AngleOptions,
  job: JobOptions,
): Promise<Estimate> {
  const { bin, cfg } = capture;
  return frame === 'all'
    ? pool().cellSpectrum(bin, cfg, cell, angle, chain, job)
    : pool().cellSpectrum(bytesOf(capture, frame), cfg, { ...cell, frame: 0 }, angle, chain, job);
}

function bytesOf({ bin, info }: Loaded, frame: number): Uint8Array {
  const { frameBytes } = info.config;
  return bin.subarray(frame * frameBytes, (frame + 1) * frameBytes);
}
