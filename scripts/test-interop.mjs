// Runs tests/interop: files exchanged with h5py, the RadarScenes package, MCAP's and rosbags.
import { pytest } from './lib/python.mjs';
import { main } from './lib/run.mjs';

await main(() => pytest('interop', 'tests/interop/requirements.txt', 'tests/interop'));
