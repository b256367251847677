import { api } from '../../data.ts';
import { preload } from '../../preload.ts';
import { bundledFiles } from './drive/drive.ts';
import { mountingCodec } from './state.ts';

export function askAhead(params: URLSearchParams): void {
  // What goes wrong here is told where it is needed.
  api.initDrives().catch(() => {});
  if (mountingCodec.read(params).source === 'delphi') for (const [, address] of bundledFiles) preload(address);
}
