// Runs training/tests: PyTorch, its simulators against the command line's. PyTorch takes 5 GB and some minutes to
// install.
import { pytest } from './lib/python.mjs';
import { main } from './lib/run.mjs';

await main(() => pytest('training', 'training/requirements.txt', 'training/tests', { OMP_NUM_THREADS: '1' }));
