import 'boresight/elements';
import { createPool } from 'boresight/worker';
import { estimates, TRUTH_DEG } from './scene.js';

/** Workers, or this thread where the host lets none start. */
async function startPool() {
  const pool = createPool({ workers: 1 });
  try {
    await pool.version();
    return pool;
  } catch (error) {
    if (error.code !== 'worker-refused') throw error;
    return createPool({ workers: 0 });
  }
}

async function show(element, started) {
  try {
    element.estimates = await estimates(await started);
  } catch (error) {
    if (element.isConnected) element.replaceWith(error.message);
  }
}

/** Shows the panel in an element of the host. What it returns takes it away and ends its workers. */
export function mount(host) {
  const element = document.createElement('boresight-spectrum');
  element.setAttribute('heading', 'Two targets');
  element.truthDeg = TRUTH_DEG;
  host.append(element);
  const started = startPool();
  void show(element, started);
  return () => {
    element.remove();
    void started.then((pool) => pool.terminate());
  };
}
