import 'boresight/elements';
import type { Estimate } from 'boresight';
import { createPool, type Pool } from 'boresight/worker';
import { useEffect, useState } from 'react';
import { estimates, OTHER_DEG } from './scene';

/** Workers that live as long as the component does. */
function useWorkers(): Pool | null {
  const [pool, setPool] = useState<Pool | null>(null);
  useEffect(() => {
    const made = createPool({ workers: 2 });
    setPool(made);
    return () => made.terminate();
  }, []);
  return pool;
}

export function Scene() {
  const pool = useWorkers();
  const [azimuthDeg, setAzimuthDeg] = useState(-12);
  const [found, setFound] = useState<Estimate[]>([]);
  const [problem, setProblem] = useState('');

  useEffect(() => {
    if (!pool) return;
    // What is under way for a slider's earlier place is dropped.
    const aborter = new AbortController();
    estimates(pool, azimuthDeg, aborter.signal).then(
      (results) => {
        if (!aborter.signal.aborted) setFound(results);
      },
      (error: Error) => {
        if (!aborter.signal.aborted) setProblem(error.message);
      },
    );
    return () => aborter.abort();
  }, [pool, azimuthDeg]);

  return (
    <section>
      <label>
        Azimuth {azimuthDeg}°{' '}
        <input
          type="range"
          min={-60}
          max={60}
          value={azimuthDeg}
          onChange={({ target }) => setAzimuthDeg(target.valueAsNumber)}
        />
      </label>
      <boresight-spectrum heading="Two targets" estimates={found} truthDeg={[azimuthDeg, OTHER_DEG]} />
      <p role="alert">{problem}</p>
    </section>
  );
}
