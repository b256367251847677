// esbuild does not follow `new URL(…, import.meta.url)`. So the pool is told where its files are: the script of the
// worker is an entry of its own, and modules are imported as files.
import core from 'boresight/boresight.wasm';
import drives from 'boresight/boresight_drives.wasm';
import { usePool } from 'boresight/elements';
import { createPool } from 'boresight/worker';

const beside = (name) => new URL(name, import.meta.url);

usePool(
  createPool({
    workers: 1,
    worker: beside('boresight.worker.js'),
    modules: { core: beside(core), drives: beside(drives) },
  }),
);
