/** The parts of a self-contained build, opened when they are needed. */
import { parts } from './packed.js';

function bytesOf(base64: string): Uint8Array<ArrayBuffer> {
  const binary = atob(base64);
  const bytes = new Uint8Array(binary.length);
  for (let k = 0; k < binary.length; k++) bytes[k] = binary.charCodeAt(k);
  return bytes;
}

/** The bytes of a part. */
export async function part(name: string): Promise<Uint8Array<ArrayBuffer>> {
  const packed = parts[name];
  if (packed === undefined) throw new Error(`this build has no part ${name}`);
  const opened = new Blob([bytesOf(packed)]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Uint8Array(await new Response(opened).arrayBuffer());
}
