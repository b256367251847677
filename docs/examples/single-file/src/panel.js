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

/** Shows the panel in an element of the host; gives what takes it away. */
export function mount(host) {
  const element = document.createElement('boresight-spectrum');
  element.setAttribute('heading', 'Two targets');
  element.truthDeg = TRUTH_DEG;
  host.append(element);
  const pool = startPool();
  const shown = pool.then(async (started) => {
    element.estimates = await estimates(started);
  });
  const unmount = async () => {
    element.remove();
    (await pool).terminate();
  };
  return { shown, unmount };
}
