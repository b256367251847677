// Runs research/training/tests: PyTorch, its simulators against the command line's. PyTorch takes 5 GB and some minutes to
// install.
import { pytest } from '../../scripts/lib/python/python.mjs';
import { main } from '../../scripts/lib/run.mjs';

await main(() =>
  pytest('training', 'research/training/requirements.txt', 'research/training/tests', { OMP_NUM_THREADS: '1' }),
);
