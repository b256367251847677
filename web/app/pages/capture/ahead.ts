import { preload } from '../../preload.ts';
import { bundledAddresses } from './files.ts';

export function askAhead(params: URLSearchParams): void {
  if (params.get('source') !== 'files') for (const address of bundledAddresses) preload(address);
}
