import { createPool } from 'boresight/worker';
import { rmseDeg } from './scenes.js';

const slider = document.querySelector('input');
const progress = document.querySelector('progress');
const output = document.querySelector('output');
const pool = createPool();
let aborter = new AbortController();

async function show() {
  aborter.abort();
  aborter = new AbortController();
  const { signal } = aborter;
  const snrDb = slider.valueAsNumber;
  const onProgress = (done, total) => {
    progress.value = done / total;
  };
  try {
    const error = await rmseDeg(pool, snrDb, { signal, onProgress });
    if (!signal.aborted) output.textContent = `${error} deg at ${snrDb} dB`;
  } catch (problem) {
    if (!signal.aborted) output.textContent = problem.message;
  }
}

slider.addEventListener('input', show);
show();
