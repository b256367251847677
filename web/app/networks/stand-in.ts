/**
 * Stands for the bindings of the module of networks, in the workers of a demo that is up before the module is built. The
 * bindings are loaded when a worker is given the module; until they are here, its messages wait.
 */
interface Bindings {
  default(options: unknown): Promise<unknown>;
  initSync(options: unknown): unknown;
  __wbg_reset_state(): void;
  lastPanic(): string;
  setLimits(limits: unknown): void;
  cubeRegions(...args: unknown[]): unknown;
  captureRegions(...args: unknown[]): unknown;
  jointCubeRegions(...args: unknown[]): unknown;
  jointCaptureRegions(...args: unknown[]): unknown;
  Network: unknown;
}

let bindings: Bindings;

export default (options: unknown): Promise<unknown> => bindings.default(options);
export const initSync = (options: unknown): unknown => bindings.initSync(options);
export const __wbg_reset_state = (): void => bindings.__wbg_reset_state();
export const lastPanic = (): string => bindings.lastPanic();
export const setLimits = (limits: unknown): void => bindings.setLimits(limits);
export const cubeRegions = (...args: unknown[]): unknown => bindings.cubeRegions(...args);
export const captureRegions = (...args: unknown[]): unknown => bindings.captureRegions(...args);
export const jointCubeRegions = (...args: unknown[]): unknown => bindings.jointCubeRegions(...args);
export const jointCaptureRegions = (...args: unknown[]): unknown => bindings.jointCaptureRegions(...args);
export let Network: unknown;

async function load(): Promise<void> {
  const address = new URL('/later/boresight_neural.js', location.href).href;
  bindings = (await import(/* @vite-ignore */ address)) as Bindings;
  ({ Network } = bindings);
}

let waiting: unknown[] | undefined;

// This runs before the worker listens itself, and so hears of a message first.
addEventListener('message', (event: MessageEvent<object>) => {
  if (waiting) waiting.push(event.data);
  else if (bindings === undefined && 'neural' in event.data) {
    waiting = [event.data];
    load().then(() => {
      const held = waiting ?? [];
      waiting = undefined;
      for (const data of held) dispatchEvent(new MessageEvent('message', { data }));
    }, reportError);
  } else return;
  event.stopImmediatePropagation();
});
