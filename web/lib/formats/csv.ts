import * as glue from '../../wasm/boresight.js';
import { call } from '../runtime/instance.js';
import type { ComplexData, Detection, TextInput } from '../types.js';

/** Detections as CSV with the columns `frame,range_m,rate_mps,azimuth_deg,...`. */
export function writeDetectionsCsv(detections: readonly Detection[]): string {
  return call(() => glue.writeDetectionsCsv(detections));
}

/** Reads what {@link writeDetectionsCsv} writes; columns may come in any order. */
export function readDetectionsCsv(table: TextInput): Detection[] {
  return call(() => glue.readDetectionsCsv(table) as Detection[]);
}

/** Snapshots (elements x snapshots) as CSV with the columns `snapshot,element,re,im`. */
export function writeSnapshotsCsv(snapshots: ComplexData): string {
  return call(() => glue.writeSnapshotsCsv(snapshots));
}

/** Reads what {@link writeSnapshotsCsv} writes. */
export function readSnapshotsCsv(table: TextInput): ComplexData {
  return call(() => glue.readSnapshotsCsv(table) as ComplexData);
}
