// A small, good call of every function and method of the package.

import { readFileSync } from 'node:fs';
import * as everything from 'boresight';
import { batchOf, planeWaves } from './assert.mjs';
import { golden } from './drives.mjs';
import { bin, cfg, dat } from './recording.mjs';

const studio = (kind) =>
  readFileSync(new URL(`../../golden/mmwave-studio/awr1642.${kind}.json`, import.meta.url), 'utf8');

const boresight = { ...everything };
const array = 'ula4';
const angle = { method: 'iaa', gridPoints: 32, iaa: { iterations: 3 } };

/**
 * Arguments by name of what is called. For a method of a handle, `Class.method`, those that the handle is made with come first.
 */
export function goodCalls() {
  const snapshots = planeWaves(4, 2, [10]);
  const waveform = { ...boresight.waveformPreset('corner'), samples: 32, transmitters: 1, loops: 4 };
  const targets = [{ rangeM: 4, azimuthDeg: 5, rateMps: 1 }];
  const simulated = { waveform, array, targets, snrDb: 20, seed: 1 };
  const cube = boresight.simulateCube(simulated);
  const still = { ...simulated, waveform: { ...waveform, samples: 64 }, targets: [{ rangeM: 8, azimuthDeg: 5 }] };
  const chain = { waveform, array };
  const image = { ...chain, angle, maxDetections: 2 };
  const framed = boresight.imageFrame(cube, image);
  const grid = { rangeM: [0, 8], ranges: 8, fieldOfViewDeg: 45, azimuths: 16 };
  const seen = {
    radars: [{ map: framed.map, mounting: { xM: 3, yM: 0, yawDeg: 5 } }],
    grid: { xM: [0, 8], yM: [-4, 4], cellM: 1 },
  };
  const view = boresight.birdsEyeView(seen);
  const bytes = Uint8Array.from(bin.subarray(0, 131_072));
  const estimator = { ...angle, array };
  const simulatedDrive = {
    durationS: 1,
    seed: 2,
    sensors: [{ id: 1, xM: 3, yM: 0, yawDeg: 10 }],
    noise: { clutter: 2 },
  };
  const drive = boresight.simulateDrive(simulatedDrive);
  const of = { sensor: 1, method: 'kabsch' };
  const { frames, mounting } = boresight.calibrateDrive(drive, of);
  const path = { timeS: drive.motion.timeS, ...drive.motion.pose };
  const calibration = { method: 'least-squares', xM: 3, yM: 0, nominalDeg: 10 };
  const frame = {
    timeS: 0.1,
    azimuthDeg: Float64Array.of(-20, 0, 20),
    rangeRateMps: Float64Array.of(-9, -10, -9),
    rangeM: Float64Array.of(5, 6, 7),
    yawRateDegps: 1,
    speedMps: 10,
  };
  // Two transmitters, one loop of two samples, four receivers a chip.
  const cascadeCfg = cfg
    .toString()
    .replace('channelCfg 15 3 0', 'channelCfg 65535 4095 1')
    .replace('60 1 256 5209', '60 1 2 5209')
    .replace('frameCfg 0 1 16', 'frameCfg 0 1 1');
  const cascadeFiles = ['master', 'slave1', 'slave2', 'slave3'].map((chip) => ({
    name: `${chip}_0000_data.bin`,
    bytes: new Uint8Array(2 * 2 * 4 * 4),
  }));
  const seen8 = (deg) => planeWaves(8, 1, [deg]);
  const detections = boresight.processCube(cube, chain)[0].detections;
  const numbers = Uint8Array.from(readFileSync(new URL('../../golden/hdf5/one.h5', import.meta.url)));
  const plain = {
    array: [
      {
        positions: [
          [0, 0, 0],
          [0, 1, 0],
        ],
      },
    ],
    waveformSummary: [waveform],
    waveformPreset: ['awr1642'],
    unsuited: [estimator, 2],
    estimate: [{ snapshots }, estimator],
    countSources: [{ snapshots }, { criterion: 'mdl' }],
    cramerRaoBound: [{ array, targets: [{ azimuthDeg: 3, snrDb: 10 }], snapshots: 2 }],
    simulateSnapshots: [{ array, targets: { count: [1, 2] }, snrDb: 10, seed: 1 }],
    simulateCube: [simulated],
    streetScene: [{ egoSpeedMps: 5 }],
    simulateStreet: [{ radar: 'nowhere' }],
    imagePlan: [image],
    imageFrame: [cube, image],
    rangeAzimuthMap: [{ cells: framed.cells, estimates: framed.estimates, from: 'targets', grid }],
    birdsEyeView: [seen],
    sidelobeMeasure: [view, [{ xM: 4, yM: 0 }], { gateM: 1 }],
    processCube: [cube, chain],
    frameCells: [cube, chain],
    calibrateArray: [{ snapshots: batchOf([seen8(10), seen8(-20)]), noisePower: 1e-4 }, { array: 'awr1642' }],
    calibrateCubeArray: [
      boresight.simulateCube({ ...still, frames: 2 }),
      { waveform: still.waveform, array },
      () => true,
    ],
    calibrateBySteeringTable: [{ azimuthDeg: [0], responses: [Array.from({ length: 4 }, () => [1, 0])] }, array],
    configuredCalibration: [cfg],
    tiCompensation: [
      boresight.calibrateArray({ snapshots: batchOf([seen8(10)]), noisePower: 1e-4 }, { array: 'awr1642' }).calibration,
      cfg,
    ],
    strongestRegion: [cube, { bins: 5, chirps: 4 }],
    parseConfig: [{ text: cfg, iqOrder: 'qi' }],
    joinCascade: [cascadeFiles, cascadeCfg],
    recordingParts: [['a_1.bin', 'a_0.bin']],
    studioConfig: [studio('mmwave'), studio('setup')],
    subFrameConfig: [cfg, 0],
    parseBoardLog: [Uint8Array.from(dat.subarray(0, 2000)), cfg],
    readNpy: [boresight.writeNpy({ kind: 'real', data: Float64Array.of(1, 2), shape: [2] })],
    writeNpy: [{ kind: 'real', data: Float64Array.of(1, 2), shape: [2] }],
    writeDetectionsCsv: [detections],
    readDetectionsCsv: [boresight.writeDetectionsCsv(detections)],
    writeSnapshotsCsv: [snapshots],
    readSnapshotsCsv: [boresight.writeSnapshotsCsv(snapshots)],
    simulateDrive: [simulatedDrive, (done) => done < 1],
    readDrive: [[golden('contiguous.h5')]],
    readArray: [numbers, { dataset: 'frames/snapshots' }],
    listArrays: [numbers],
    calibrateDrive: [drive, of],
    jointCalibration: [drive, { sensors: [1] }],
    calibrationReport: [
      drive,
      { made: 'now', asked: 'so', sources: [{ name: 'a.csv', bytes: 3, sha256: 'ab' }] },
      { sensor: 1 },
    ],
    scanMotion: [drive, { maxGapS: 0.2 }],
    mergeCalibrations: [[snapshotOf(calibration, frame)]],
    driveFrame: [drive, 1, boresight.scanMotion(drive)],
    trajectory: [frames, { ...mounting, angleDeg: 10 }],
    relativeTrajectoryError: [path, path, 2],
  };
  const methods = {
    'Estimator.estimate': [estimator, { snapshots }],
    'Estimator.estimateBatch': [estimator, { snapshots: batchOf([snapshots, snapshots]) }, { spectra: true }],
    'Capture.processFrame': [bytes, cfg, 0, { angle }],
    'Capture.frameCells': [bytes, cfg, 0, { peakGrouping: false }],
    'Capture.cellSnapshots': [bytes, cfg, { rangeBin: 58, dopplerBin: 8 }, {}],
    'Capture.explainCell': [bytes, cfg, { rangeBin: 58, dopplerBin: 8 }, {}],
    'Capture.cellSpectrum': [bytes, cfg, { rangeBin: 58, dopplerBin: 8 }, angle, {}],
    'Capture.calibrateArray': [bytes, cfg, { maxCells: 4 }, () => true],
    'Capture.combineFrames': [bytes, cfg, { frameCount: 1, angle }, () => true],
    'BoardLogStream.push': [cfg, Uint8Array.from(dat.subarray(0, 500))],
    'DriveStream.push': [{}, Uint8Array.of(0x89, 0x4d, 0x43, 0x41, 0x50, 0x30, 0x0d, 0x0a)],
    'Calibration.addFrame': [calibration, frame],
    'Calibration.estimate': [calibration],
    'Calibration.snapshot': [recursive(calibration)],
  };
  return { ...plain, ...methods };
}

const recursive = (options) => ({ ...options, method: 'recursive', motion: 'tracked' });

/** A calibration that has taken a frame, as bytes. */
function snapshotOf(options, frame) {
  const made = new boresight.Calibration(recursive(options));
  made.addFrame(frame);
  const bytes = made.snapshot();
  made.free();
  return bytes;
}

/** What goes on over time: sources of bytes and frames, and what is sent to a board. */
export const live = ['boardFrames', 'bridgeFrames', 'RecentBytes', 'replayBytes', 'sendConfiguration', 'serialBytes'];

/** How many arguments handles are made with. */
const MADE_WITH = { Estimator: 1, Capture: 2, BoardLogStream: 1, DriveStream: 1, Calibration: 1 };

/** Calls by name with arguments as {@link goodCalls} has them. */
export function callBy(name, args) {
  const [first, method] = name.split('.');
  if (method === undefined) return boresight[name](...args);
  const handle = new boresight[first](...args.slice(0, MADE_WITH[first]));
  try {
    return handle[method](...args.slice(MADE_WITH[first]));
  } finally {
    handle.free();
  }
}
