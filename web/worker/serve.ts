// The inside of a worker.

import { drives as drivesModule, initDrivesSync } from '../lib/drive/drive.js';
import { initNeuralSync, neural as neuralModule } from '../lib/neural/network.js';
import { BoresightError, failure } from '../lib/runtime/errors.js';
import { core, initSync } from '../lib/runtime/instance.js';
import { Instance } from '../lib/runtime/module.js';
import { forgetCapture, keepCapture } from './captures.js';
import { forgetNetwork, keepNetwork } from './networks.js';
import { type Context, operations } from './operations.js';
import type { Reply, Request, Setup } from './protocol.js';
import { forgetStream, keepStream } from './streams.js';
import { buffersOf } from './transfer.js';

/** How requests are run. */
interface Running {
  /** Whether the request that runs is to stop where it reports. */
  isStopped(): boolean;
  around<T>(work: () => T): T;
}

/** In a thread of their own. */
const plainly: Running = { isStopped: () => false, around: (work) => work() };

/** Answers messages of the pool; `post` sends the answer. */
export function serve(
  post: (reply: Reply, transfer: Transferable[]) => void,
  running: Running = plainly,
): (message: Setup | Request) => void {
  let module: WebAssembly.Module | undefined;
  let drives: WebAssembly.Module | undefined;
  let neural: WebAssembly.Module | undefined;
  return (message) => {
    if ('module' in message) {
      module = message.module;
      return;
    }
    if ('limits' in message) {
      Instance.setLimits(message.limits);
      return;
    }
    if ('drives' in message) {
      drives = message.drives;
      return;
    }
    if ('neural' in message) {
      neural = message.neural;
      return;
    }
    if ('keep' in message) {
      if (message.keep === 'network') keepNetwork(message.of, message.file);
      else if (message.keep === 'stream') keepStream(message.of, message.file);
      else keepCapture(message.of, message.file);
      return;
    }
    if ('forget' in message) {
      if (message.forget === 'network') forgetNetwork(message.of);
      else if (message.forget === 'stream') forgetStream(message.of);
      else forgetCapture(message.of);
      return;
    }
    const { id, name, args } = message;
    try {
      if (module === undefined)
        throw failure('not-initialised', { what: 'worker', expected: 'a module', given: 'none' });
      initSync(module); // makes a fresh instance where the last one stopped
      if (drives !== undefined) initDrivesSync(drives);
      if (neural !== undefined) initNeuralSync(neural);
      const operation = operations[name] as (this: Context, ...args: readonly unknown[]) => unknown;
      const report = (done: number, total: number): boolean => {
        post({ id, done, total }, []);
        return !running.isStopped();
      };
      const result = running.around(() => operation.apply({ report }, args as unknown[]));
      post({ id, result, memoryBytes: memoryBytes() }, buffersOf(result));
    } catch (thrown) {
      post({ id, error: asTyped(thrown).toPlain(), memoryBytes: memoryBytes() }, []);
    }
  };
}

const memoryBytes = (): number =>
  [core, drivesModule, neuralModule].reduce((sum, instance) => sum + instance.memoryBytes, 0);

/** What was thrown, as an error of the package. */
export function asTyped(thrown: unknown): BoresightError {
  if (thrown instanceof BoresightError) return thrown;
  return failure('worker-failed', { what: 'worker', expected: 'a result', given: String(thrown) }, thrown);
}
