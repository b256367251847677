// A thread that packs what it is given.
import { parentPort, workerData } from 'node:worker_threads';
import { pack } from './lzma.mjs';

const { bytes, layout } = workerData;
parentPort.postMessage(pack(bytes, await import(layout)));
