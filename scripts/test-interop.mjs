// Runs tests/interop: files exchanged with h5py and the RadarScenes package, and metrics read by Prometheus's parsers.
import { pytest } from './lib/python.mjs';
import { main } from './lib/run.mjs';

await main(() => pytest('interop', 'tests/interop/requirements.txt', 'tests/interop'));
