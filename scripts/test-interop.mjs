// Runs tests/interop: files and metrics exchanged with h5py, the RadarScenes package, MCAP's, rosbags and Prometheus's.
import { pytest } from './lib/python/python.mjs';
import { main } from './lib/run.mjs';

await main(() => pytest('interop', 'tests/interop/requirements.txt', 'tests/interop'));
