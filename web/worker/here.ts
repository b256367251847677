// Work on the thread that asks for it, for hosts that allow no workers.
import { drives } from '../lib/drive/drive.js';
import { neural } from '../lib/neural/network.js';
import { failure } from '../lib/runtime/errors.js';
import { core } from '../lib/runtime/instance.js';
import { Instance } from '../lib/runtime/module.js';
import type { Limits } from '../lib/types.js';
import type { Files, Reply, Request, Setup, WorkerEvents, WorkerLike } from './protocol.js';
import { asTyped, serve } from './serve.js';
import { turn } from './turn.js';

/** What stands for a worker: takes the same messages and answers them between other tasks of the thread. */
export function workHere(events: WorkerEvents): WorkerLike {
  let limits: Limits | undefined;
  let stopped = false;
  let ended = false;
  let running = false;
  /** What callbacks of the request that runs asked for: what it uses is not forgotten under it. */
  const later: (() => void)[] = [];
  const whenIdle = (work: () => void): void => {
    if (running) later.push(work);
    else work();
  };
  const starts = new Set<() => Promise<void>>();
  const kept = new Map<string, keyof Files>();
  const reply = (reply: Reply): void => {
    // The thread's memory cannot be given back by ending a worker.
    if (!ended) events.reply('memoryBytes' in reply ? { ...reply, memoryBytes: 0 } : reply);
  };
  const answer = serve(reply, {
    isStopped: () => stopped,
    around: (work) => (limits === undefined ? work() : Instance.withLimits(limits, work)),
  });

  const prepare = (message: Setup): void => {
    if ('limits' in message) {
      limits = message.limits;
      return;
    }
    // Shared with what else starts the thread's instances meanwhile.
    if ('module' in message) starts.add(() => core.start(() => message.module));
    if ('drives' in message) starts.add(() => drives.start(() => message.drives));
    if ('neural' in message) starts.add(() => neural.start(() => message.neural));
    if ('keep' in message) kept.set(message.of, message.keep);
    if ('forget' in message) kept.delete(message.of);
    answer(message);
  };

  const run = async (request: Request): Promise<void> => {
    try {
      await turn();
      for (const start of starts) await start();
      if (stopped) throw failure('cancelled', { what: 'job', expected: 'to be wanted', given: 'withdrawn' });
    } catch (thrown) {
      reply({ id: request.id, error: asTyped(thrown).toPlain(), memoryBytes: 0 });
      return;
    }
    if (ended) return;
    running = true;
    try {
      answer(request);
    } finally {
      running = false;
      for (const work of later.splice(0)) work();
    }
  };

  return {
    post(message, transfer) {
      if (!('name' in message)) {
        whenIdle(() => prepare(message));
        return;
      }
      stopped = false;
      void run(structuredClone(message, { transfer }));
    },
    keepAlive: () => {},
    stop() {
      stopped = true;
    },
    terminate() {
      ended = true;
      whenIdle(() => {
        for (const [of, forget] of kept) answer({ forget, of });
      });
    },
  };
}
