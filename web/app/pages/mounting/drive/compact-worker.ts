/** Makes the bundled drive's table beside the page. */
import { tableOf } from './compact.ts';

addEventListener('message', ({ data }: MessageEvent<Uint8Array>) => {
  const table = tableOf(data);
  postMessage(table, { transfer: [table.buffer] });
});
