// The parts of a self-contained build, opened in their order as far as they are needed.
import { unpacker } from '../lib/runtime/lzma.js';
import { turn } from '../worker/turn.js';
import { parts, text } from './packed.js';

/** Bytes opened without a pause, some 30 ms. */
const STEP = 1 << 18;

let opened: { bytes: Uint8Array<ArrayBuffer>; unpack: (until: number) => void; done: number } | undefined;
let last: Promise<void> = Promise.resolve();

function open(): NonNullable<typeof opened> {
  const size = Object.values(parts).reduce((sum, bytes) => sum + bytes, 0);
  const bytes = new Uint8Array(size);
  return { bytes, unpack: unpacker(bytesOf(text), bytes), done: 0 };
}

/** The bytes of base64. */
function bytesOf(base64: string): Uint8Array {
  const binary = atob(base64);
  const bytes = new Uint8Array(binary.length);
  for (let k = 0; k < binary.length; k++) bytes[k] = binary.charCodeAt(k);
  return bytes;
}

/** A part; the thread has turns meanwhile. Whoever asks later waits for who asked before. */
export async function part(name: string): Promise<Uint8Array<ArrayBuffer>> {
  const before = last;
  let done = (): void => {};
  last = new Promise((resolve) => {
    done = resolve;
  });
  await before;
  try {
    opened ??= open();
    const names = Object.keys(parts);
    const ends = names.map((_, index) => names.slice(0, index + 1).reduce((sum, name) => sum + (parts[name] ?? 0), 0));
    const end = ends[names.indexOf(name)] ?? 0;
    while (opened.done < end) {
      opened.done = Math.min(opened.done + STEP, end);
      opened.unpack(opened.done);
      await turn();
    }
    return opened.bytes.subarray(end - (parts[name] ?? 0), end);
  } finally {
    done();
  }
}
