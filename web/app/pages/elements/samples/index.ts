import type { Sample } from '../sample.ts';
import { birdsEye } from './birds-eye.ts';
import { board } from './board.ts';
import { capture } from './capture.ts';
import { dopplerAzimuth } from './doppler-azimuth.ts';
import { drive } from './drive.ts';
import { mountingAngle } from './mounting-angle.ts';
import { pointCloud } from './point-cloud.ts';
import { rangeDoppler } from './range-doppler.ts';
import { spectrum } from './spectrum.ts';

export const SAMPLES: readonly Sample[] = [
  spectrum,
  rangeDoppler,
  pointCloud,
  birdsEye,
  dopplerAzimuth,
  mountingAngle,
  capture,
  drive,
  board,
];
