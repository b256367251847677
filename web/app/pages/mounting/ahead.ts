/** Asks for what the page needs while the signal processing is still on its way, in place of after it. */
import { api } from '../../data.ts';
import { bundledFiles } from './drive.ts';
import { mountingCodec } from './state.ts';

export function askAhead(params: URLSearchParams): void {
  // What goes wrong here is told where it is needed.
  api.initDrives().catch(() => {});
  if (mountingCodec.read(params).source !== 'delphi') return;
  for (const [, address] of bundledFiles) {
    const link = document.createElement('link');
    Object.assign(link, { rel: 'preload', as: 'fetch', crossOrigin: 'anonymous', fetchPriority: 'low', href: address });
    document.head.append(link);
  }
}
