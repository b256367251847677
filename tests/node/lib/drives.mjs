// Drives of the tests, recorded and simulated.

import { readFileSync } from 'node:fs';
import { simulateDrive } from 'boresight';

const file = (folder, name) => ({ name, bytes: readFileSync(new URL(`../../../${folder}/${name}`, import.meta.url)) });

/** A front radar's tracks and the car's poses, 600 s. */
export const delphi = () => ['front_radar.csv.gz', 'pose_10hz.csv.gz'].map((name) => file('recordings/delphi', name));

/** A small file in the layout of RadarScenes, made by h5py. */
export const golden = (name) => file('tests/golden/radarscenes', name);

/** The first seconds of a drive of one radar. */
export function beginning(drive, untilS) {
  const scans = drive.scans.timeS.findIndex((time) => time > untilS);
  const { timeS, sensor, offsets } = drive.scans;
  return {
    ...drive,
    scans: { timeS: timeS.slice(0, scans), sensor: sensor.slice(0, scans), offsets: offsets.slice(0, scans + 1) },
  };
}

/** Forty seconds of a city with four radars, of which the third is turned by two degrees. */
export const fourRadars = () => simulateDrive({ scenario: 'city', seed: 3, durationS: 40, misalignmentDeg: { 3: 2 } });
