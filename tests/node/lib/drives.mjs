// Recorded drives.
import { readFileSync } from 'node:fs';

const file = (folder, name) => ({ name, bytes: readFileSync(new URL(`../../../${folder}/${name}`, import.meta.url)) });

/** A front radar's tracks and the car's poses, 600 s. */
export const delphi = () => ['front_radar.csv.gz', 'pose_10hz.csv.gz'].map((name) => file('recordings/delphi', name));

/** A small file in the layout of RadarScenes, made by h5py. */
export const golden = (name) => file('tests/golden/radarscenes', name);
