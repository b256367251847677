import 'boresight/elements';
import { createPool } from 'boresight/worker';
import { pictures } from './walkers.js';

const slider = document.querySelector('input');
const rangeDoppler = document.querySelector('boresight-range-doppler');
const birdsEye = document.querySelector('boresight-birds-eye');
const pool = createPool({ workers: 2 });
let wanted = 0;

async function show() {
  wanted += 1;
  const mine = wanted;
  const { frame, view } = await pictures(pool, slider.valueAsNumber);
  if (mine !== wanted) return;
  rangeDoppler.frame = frame;
  birdsEye.view = view;
}

slider.addEventListener('input', show);
show();
