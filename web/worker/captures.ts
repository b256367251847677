// The captures of a worker: their files as the pool sent them, and in wasm memory those in use.
import { Capture } from '../lib/capture/capture.js';
import { failure } from '../lib/runtime/errors.js';
import { core } from '../lib/runtime/instance.js';
import type { BytesInput, CaptureFile, ConfigInput } from '../lib/types.js';

/** Bytes that come with a job, or the id of a capture that the pool keeps. */
export type CaptureSource = BytesInput | { capture: string };

interface Open {
  capture: Capture;
  /** Number of the instance it lives in. */
  instance: number;
}

const files = new Map<string, CaptureFile>();
const opened = new Map<string, Open>();

export function keepCapture(id: string, file: CaptureFile): void {
  files.set(id, file);
}

export function forgetCapture(id: string): void {
  files.delete(id);
  // The memory of an instance that is gone went with it.
  opened.get(id)?.capture[Symbol.dispose]();
  opened.delete(id);
}

const keptId = (source: CaptureSource): string | undefined =>
  typeof source === 'object' && source !== null && 'capture' in source ? source.capture : undefined;

function fileOf(id: string): CaptureFile {
  const file = files.get(id);
  if (file) return file;
  throw failure('unknown-capture', { what: 'capture', expected: 'one that the pool has loaded', given: id });
}

export function bytesOf(source: CaptureSource): BytesInput {
  const id = keptId(source);
  return id === undefined ? (source as BytesInput) : fileOf(id).bytes;
}

/** Runs `work` with a capture: a kept one is opened once, and once more after a trap; any other is freed. */
export function withCapture<T>(source: CaptureSource, config: ConfigInput, work: (capture: Capture) => T): T {
  const id = keptId(source);
  if (id !== undefined) {
    let one = opened.get(id);
    if (one?.instance !== core.number) {
      const { bytes } = fileOf(id);
      one = { capture: new Capture(bytes, config), instance: core.number };
      opened.set(id, one);
    }
    return work(one.capture);
  }
  const capture = new Capture(source as BytesInput, config);
  try {
    return work(capture);
  } finally {
    capture.free();
  }
}
