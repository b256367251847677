/** The frame that is shown: its detections, and what the methods made of them. */

import { computed } from '@preact/signals';
import type { DriveFrame, FrameVerdict } from 'boresight';
import { carriedMotion, type Motion } from '../../../../plots/doppler.ts';
import { api } from '../../../data.ts';
import { loaded, scans } from '../drive/drive.ts';
import { frame } from '../drive/playhead.ts';
import type { Way } from '../motion/ways.ts';
import { results, shown, shownMethod, where } from '../results/process.ts';

export interface FrameView extends DriveFrame {
  /** For each detection the weight with which it was taken as static; null where none was weighed. */
  weights: Float32Array | null;
  /** For each detection whether it truly comes from something moving, where the drive knows. */
  moving: Uint8Array | null;
  verdict: FrameVerdict | null;
  /** The radar's own motion, by the method that is shown. */
  motion: Motion | null;
  /** The same by every method that has one. */
  motions: ReadonlyMap<Way, Motion>;
  angleDeg: number | null;
  angleSigmaDeg: number | null;
}

/** RadarScenes' class of what does not move. */
const STATIC_LABEL = 11;

/** The radar's motion as the car's speed and yaw rate, and the angle in use, have it. */
export function expectedMotion({ speedMps, yawRateDegps }: DriveFrame): Motion | null {
  const at = where.value;
  if (speedMps == null || yawRateDegps === null || at === null || at.xM === null) return null;
  return carriedMotion({ xM: at.xM, yM: at.yM, yawDeg: usedAngleDeg.value }, speedMps, yawRateDegps);
}

export const frameView = computed<FrameView | null>(() => {
  const { drive, motion, truth } = loaded.value ?? {};
  const { scan } = scans.value;
  const index = frame.value;
  const at = scan[index];
  if (!drive || !motion || at === undefined) return null;
  const motions = new Map<Way, Motion>();
  for (const [method, { calibration }] of results.value) {
    const vxMps = calibration?.frames.vxMps[index];
    const vyMps = calibration?.frames.vyMps[index];
    if (vxMps !== undefined && vyMps !== undefined && Number.isFinite(vxMps)) motions.set(method, { vxMps, vyMps });
  }
  const calibration = shown.value;
  const frames = calibration?.frames;
  const known = (value: number | undefined): number | null =>
    value !== undefined && Number.isFinite(value) ? value : null;
  const { offsets, values } = frames?.weights ?? {};
  const weights = offsets && values?.subarray(offsets[index], offsets[index + 1]);
  const read = api.driveFrame(drive, at, motion);
  const labelled = read.label?.map((label) => Number(label !== STATIC_LABEL));
  return {
    ...read,
    moving: truth?.moving.subarray(drive.scans.offsets[at], drive.scans.offsets[at + 1]) ?? labelled ?? null,
    weights: weights?.some((weight) => weight > 0) ? weights : null,
    verdict: (frames && api.frameVerdicts[frames.verdict[index] ?? -1]) ?? null,
    motion: (shownMethod.value && motions.get(shownMethod.value)) ?? null,
    motions,
    angleDeg: known(frames?.angleDeg[index]),
    angleSigmaDeg: known(frames?.angleSigmaDeg[index]),
  };
});

/** The angle in use: the one that was found, else the nominal one. */
export const usedAngleDeg = computed(() => shown.value?.result.angleDeg ?? where.value?.nominalDeg ?? 0);

/** Numbers of the detections of the radar that is looked at, at most about 20,000 of them. */
export const sample = computed(() => {
  const drive = loaded.value?.drive;
  const { scan } = scans.value;
  if (!drive) return [];
  const { offsets } = drive.scans;
  const total = scan.reduce((sum, at) => sum + (offsets[at + 1] as number) - (offsets[at] as number), 0);
  const every = Math.max(Math.ceil(total / 20_000), 1);
  const numbers: number[] = [];
  for (let i = 0; i < scan.length; i += every) {
    const at = scan[i] as number;
    for (let k = offsets[at] as number; k < (offsets[at + 1] as number); k++) numbers.push(k);
  }
  return numbers;
});
