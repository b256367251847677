import { pool } from '../../data.ts';
import { networksModule } from '../../networks/address.ts';
import { MODELS } from '../../networks/models.ts';
import { hasModule } from '../../networks/module.ts';
import { preload } from '../../preload.ts';
import { networksCodec } from './state.ts';

export function askAhead(params: URLSearchParams): void {
  const { run, model } = networksCodec.read(params);
  const { address } = MODELS.find(({ name }) => name === model) ?? {};
  if (!run || !address || !hasModule) return;
  preload(networksModule.href);
  preload(address);
  // A worker starts meanwhile. What goes wrong is told where it is needed.
  pool()
    .version()
    .catch(() => {});
}
