import { preload } from '../../preload.ts';
import { bundledAddresses } from './files/files.ts';

export function askAhead(params: URLSearchParams): void {
  const source = params.get('source') ?? 'bundled';
  if (source === 'bundled') for (const address of bundledAddresses) preload(address);
}
