// A pool of single-thread workers: queue, progress, cancelling, replacement of what died.
import { BoresightError, failure } from '../lib/runtime/errors.js';
import type { Limits } from '../lib/types.js';
import { checkedJob, type JobOptions, passedOn } from './job.js';
import type { Files, OperationName, Operations, Reply, Setup, WorkerEvents, WorkerLike } from './protocol.js';
import { packed } from './transfer.js';

/** A piece of a job for one worker. */
export interface Piece<N extends OperationName> {
  name: N;
  args: Parameters<Operations[N]>;
  /** Its share of the progress. */
  units: number;
  /** The network it needs, or several. */
  network?: string | readonly string[] | undefined;
  /** The kept capture it needs. */
  capture?: string | undefined;
}

/** How a runtime makes workers. */
export interface Runtime {
  /** Number of workers where the user names none. */
  workers(): number;
  compile(): Promise<WebAssembly.Module>;
  /** The module of drives and mounting angles. */
  compileDrives(): Promise<WebAssembly.Module>;
  /** The module of networks. */
  compileNeural(): Promise<WebAssembly.Module>;
  spawn(events: WorkerEvents): WorkerLike;
}

/** What needs the module of drives. */
const ofDrives: readonly OperationName[] = [
  'readDrive',
  'simulateDrive',
  'driveScenarios',
  'scanMotion',
  'calibrateDrive',
  'jointCalibration',
  'calibrationReport',
  'mergeCalibrations',
];

/** Memory that the copies of one capture in the workers may take, bytes; one worker has it in any case. */
const COPIES_BYTES = 256 * 1024 * 1024;

/** Memory of modules never shrinks: a worker that holds more than this beside what its kept files need is replaced, bytes. */
const LARGE_BYTES = 1024 ** 3;
/** Memory that a kept file needs, by its size: a network has plans beside its weights. */
const KEPT = 3;

/** How long a cancelled piece may run on before its worker is replaced, ms. */
const GRACE_MS = 50;

interface Job {
  pieces: Piece<OperationName>[];
  results: unknown[];
  /** Pieces done. */
  finished: number;
  /** Units done. */
  done: number;
  total: number;
  /** Whether the worker itself says how far the job is. */
  reported: boolean;
  options: JobOptions;
  settled: boolean;
  resolve(results: unknown[]): void;
  reject(reason: unknown): void;
}

/** How a piece ended. */
type Outcome = Exclude<Reply, { done: number }>;

interface Task {
  job: Job;
  index: number;
}

interface Member {
  worker: WorkerLike;
  task: Task | undefined;
  hasDrives: boolean;
  hasNeural: boolean;
  /** Ids of the files it keeps. */
  kept: Set<string>;
}

type Kept = { [K in keyof Files]: { kind: K; file: Files[K]; most: number } }[keyof Files];

/** Compiles a module once; after a failure the next call tries again. */
class Loader {
  readonly #compile: () => Promise<WebAssembly.Module>;
  readonly #file: string;
  #pending: Promise<WebAssembly.Module> | undefined;
  module: WebAssembly.Module | undefined;

  constructor(compile: () => Promise<WebAssembly.Module>, file: string) {
    this.#compile = compile;
    this.#file = file;
  }

  async load(): Promise<void> {
    this.#pending ??= this.#compile();
    try {
      this.module = await this.#pending;
    } catch (cause) {
      this.#pending = undefined;
      const given = cause instanceof Error ? cause.message : String(cause);
      const details = { what: 'WebAssembly module', expected: `the ${this.#file} of this package`, given };
      throw failure('not-loaded', details, cause);
    }
  }
}

/** The queue and the workers; the API over it is in api.ts. */
export class Crew {
  readonly size: number;
  readonly #runtime: Runtime;
  readonly #limits: Limits;
  readonly #members = new Set<Member>();
  #queue: Task[] = [];
  readonly #core: Loader;
  readonly #drives: Loader;
  readonly #neural: Loader;
  readonly #kept = new Map<string, Kept>();
  #terminated = false;
  #lastId = 0;
  #lastKept = 0;

  constructor(runtime: Runtime, workers: number | undefined, limits: Limits | undefined) {
    const size = workers ?? runtime.workers();
    if (!Number.isInteger(size) || size < 1 || size > 64) {
      throw failure('out-of-range', {
        what: 'workers',
        expected: 'a whole number from 1 to 64',
        given: String(workers),
      });
    }
    this.#runtime = runtime;
    // Whoever waits for a job can cancel it.
    this.#limits = { operations: Number.MAX_VALUE, ...limits };
    this.#core = new Loader(() => runtime.compile(), 'boresight_bg.wasm');
    this.#drives = new Loader(() => runtime.compileDrives(), 'boresight_drives_bg.wasm');
    this.#neural = new Loader(() => runtime.compileNeural(), 'boresight_neural_bg.wasm');
    this.size = size;
  }

  /** Takes a network, whose file each worker gets when it first needs it. */
  addNetwork(file: Files['network']): string {
    return this.#add({ kind: 'network', file, most: this.size });
  }

  /** Takes a capture, which no more workers get than its size allows: the others leave its jobs to those. */
  addCapture(file: Files['capture']): string {
    const most = Math.max(1, Math.floor(COPIES_BYTES / (file.bytes.byteLength || 1)));
    return this.#add({ kind: 'capture', file, most });
  }

  #add(kept: Kept): string {
    const id = `${kept.kind}-${++this.#lastKept}`;
    this.#kept.set(id, kept);
    return id;
  }

  /** Forgets a network or a capture, and makes the workers do so; whether there was one. */
  remove(kind: keyof Files, id: string): boolean {
    if (this.#kept.get(id)?.kind !== kind) return false;
    for (const member of this.#members) if (member.kept.delete(id)) member.worker.post({ forget: kind, of: id }, []);
    return this.#kept.delete(id);
  }

  /** Runs the pieces on the workers; their results in the order of the pieces. */
  async run<N extends OperationName>(pieces: Piece<N>[], given?: JobOptions): Promise<ReturnType<Operations[N]>[]> {
    const options = checkedJob(given);
    options.signal?.throwIfAborted();
    if (this.#terminated) throw terminated();
    const needed = pieces.flatMap(needs);
    for (const [kind, id] of needed) this.#find(kind, id);
    await this.#core.load();
    if (pieces.some(({ name }) => ofDrives.includes(name))) await this.#drives.load();
    if (needed.some(([kind]) => kind === 'network')) await this.#neural.load();
    if (this.#terminated) throw terminated();
    options.signal?.throwIfAborted();
    return new Promise((resolve, reject) => {
      const job: Job = {
        pieces,
        results: [],
        finished: 0,
        done: 0,
        total: pieces.reduce((sum, piece) => sum + piece.units, 0),
        reported: false,
        options,
        settled: false,
        resolve: resolve as (results: unknown[]) => void,
        reject,
      };
      this.#watch(job);
      if (pieces.length === 0) job.resolve([]);
      this.#queue.push(...pieces.map((_, index) => ({ job, index })));
      this.#dispatch();
    });
  }

  /** Ends all workers; jobs under way reject. */
  terminate(): void {
    this.#terminated = true;
    const jobs = new Set(
      [...this.#queue, ...[...this.#members].flatMap(({ task }) => task ?? [])].map(({ job }) => job),
    );
    for (const member of this.#members) this.#dismiss(member);
    for (const job of jobs) job.reject(terminated());
    this.#queue = [];
  }

  /** Makes the job settle once, and takes its pieces back when it fails or is cancelled. */
  #watch(job: Job): void {
    const { resolve, reject } = job;
    const { signal } = job.options;
    const onAbort = (): void => job.reject(signal?.reason);
    const settle =
      <T>(then: (value: T) => void) =>
      (value: T): void => {
        if (job.settled) return;
        job.settled = true;
        signal?.removeEventListener('abort', onAbort);
        then(value);
      };
    job.resolve = settle(resolve);
    job.reject = settle((reason: unknown) => {
      reject(reason);
      this.#withdraw(job);
    });
    signal?.addEventListener('abort', onAbort);
  }

  #withdraw(job: Job): void {
    this.#queue = this.#queue.filter((task) => task.job !== job);
    for (const member of this.#members) {
      const task = member.task;
      if (task?.job !== job) continue;
      // A piece about to end costs less than a new worker.
      setTimeout(() => {
        if (member.task !== task) return;
        this.#dismiss(member);
        this.#dispatch();
      }, GRACE_MS);
    }
  }

  #dispatch(): void {
    for (let at = 0; at < this.#queue.length && !this.#terminated; ) {
      const task = this.#queue[at] as Task;
      const member = this.#memberFor(task);
      if (member) {
        this.#queue.splice(at, 1);
        this.#give(member, task);
      } else at += 1;
    }
  }

  /** Who is free for a task: one that has what it needs, before others that would have to be given it. */
  #memberFor({ job, index }: Task): Member | undefined {
    const idle = [...this.#members].filter(({ task }) => task === undefined);
    const id = job.pieces[index]?.capture;
    const kept = id === undefined ? undefined : this.#kept.get(id);
    if (id === undefined || kept === undefined) return idle[0] ?? this.#hire();
    const having = idle.find((member) => member.kept.has(id));
    if (having) return having;
    const copies = [...this.#members].filter((member) => member.kept.has(id)).length;
    return copies < kept.most ? (idle[0] ?? this.#hire()) : undefined;
  }

  #give(member: Member, task: Task): void {
    const { job, index } = task;
    const piece = job.pieces[index];
    if (!piece) return;
    try {
      const { value, buffers } = packed(piece.args, job.options.transfer ?? false);
      member.task = task;
      member.worker.keepAlive(true);
      if (this.#drives.module && ofDrives.includes(piece.name) && !member.hasDrives) {
        member.worker.post({ drives: this.#drives.module }, []);
        member.hasDrives = true;
      }
      for (const [kind, id] of needs(piece)) this.#giveKept(member, kind, id);
      member.worker.post({ id: ++this.#lastId, name: piece.name, args: value }, buffers);
    } catch (cause) {
      this.#release(member);
      if (cause instanceof BoresightError) job.reject(cause);
      else
        job.reject(
          failure(
            'wrong-type',
            { what: 'arguments', expected: 'what can be sent to a worker', given: String(cause) },
            cause,
          ),
        );
    }
  }

  #giveKept(member: Member, kind: keyof Files, id: string): void {
    if (kind === 'network' && this.#neural.module && !member.hasNeural) {
      member.worker.post({ neural: this.#neural.module }, []);
      member.hasNeural = true;
    }
    if (member.kept.has(id)) return;
    const { value, buffers } = packed(this.#find(kind, id).file, false);
    member.worker.post({ keep: kind, of: id, file: value } as Setup, buffers);
    member.kept.add(id);
  }

  #keptBytes({ kept }: Member): number {
    return [...kept].reduce((sum, id) => {
      const file = this.#kept.get(id)?.file;
      if (!file) return sum;
      // What was given may be no such file: its worker says so.
      const bytes: { byteLength: number } | undefined = 'onnx' in file ? file.onnx : file.bytes;
      return sum + KEPT * (bytes?.byteLength ?? 0);
    }, 0);
  }

  #find(kind: keyof Files, id: string): Kept {
    const kept = this.#kept.get(id);
    if (kept?.kind === kind) return kept;
    throw failure(`unknown-${kind}`, {
      what: kind,
      expected: `the id of a ${kind} that this pool has loaded`,
      given: String(id),
    });
  }

  #hire(): Member | undefined {
    if (this.#members.size >= this.size || this.#core.module === undefined) return undefined;
    const events: WorkerEvents = {
      reply: (reply) => this.#finish(member, reply),
      lost: (reason) => this.#lose(member, reason),
    };
    const member: Member = {
      worker: this.#runtime.spawn(events),
      task: undefined,
      hasDrives: false,
      hasNeural: false,
      kept: new Set(),
    };
    this.#members.add(member);
    member.worker.post({ module: this.#core.module }, []);
    member.worker.post({ limits: this.#limits }, []);
    return member;
  }

  #finish(member: Member, reply: Reply): void {
    const task = member.task;
    if (!task) return;
    if ('done' in reply) {
      this.#report(task.job, reply.done, reply.total);
      return;
    }
    this.#release(member);
    if (reply.memoryBytes > LARGE_BYTES + this.#keptBytes(member)) this.#dismiss(member);
    this.#settle(task, reply);
    this.#dispatch();
  }

  #settle({ job, index }: Task, reply: Outcome): void {
    if (job.settled) return;
    if ('error' in reply) {
      job.reject(BoresightError.fromPlain(reply.error));
      return;
    }
    job.results[index] = reply.result;
    job.finished += 1;
    job.done += job.pieces[index]?.units ?? 0;
    // A job of one piece that reports by itself has done so.
    if (!job.reported) this.#report(job, job.done, job.total);
    if (job.finished === job.pieces.length) job.resolve(job.results);
  }

  #report(job: Job, done: number, total: number): void {
    if (job.settled) return;
    job.reported ||= job.finished === 0;
    try {
      job.options.onProgress?.(done, total);
    } catch (thrown) {
      job.reject(passedOn(thrown));
    }
  }

  #lose(member: Member, reason: string): void {
    const task = member.task;
    if (!this.#members.has(member)) return;
    this.#dismiss(member);
    const details = { what: 'worker', expected: 'an answer', given: reason };
    task?.job.reject(new BoresightError('worker-lost', `a worker was lost: ${reason}`, details));
    this.#dispatch();
  }

  #release(member: Member): void {
    member.task = undefined;
    member.worker.keepAlive(false);
  }

  #dismiss(member: Member): void {
    this.#members.delete(member);
    member.task = undefined;
    member.worker.terminate();
  }
}

function terminated(): BoresightError {
  return failure('terminated', { what: 'worker pool', expected: 'a running pool', given: 'terminated' });
}

/** The kept files that a piece names. */
function needs({ network, capture }: Piece<OperationName>): [keyof Files, string][] {
  return [
    ...(network === undefined ? [] : [network].flat().map((id) => ['network', id] as [keyof Files, string])),
    ...(capture === undefined ? [] : [['capture', capture] as [keyof Files, string]]),
  ];
}
