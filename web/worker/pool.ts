// A pool of single-thread workers: queue, progress, cancelling, replacement of what died.
import { BoresightError, failure } from '../lib/runtime/errors.js';
import type { Limits } from '../lib/types.js';
import { checkedJob, type JobOptions, passedOn } from './job.js';
import { type Loaders, loadersOf, type PoolModules } from './modules.js';
import { checkedOptions, type PoolOptions, type WorkerSource } from './options.js';
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
  /** The recording it is a piece of, which one worker reads. */
  stream?: string | undefined;
}

/** How a runtime makes workers. */
export interface Runtime {
  /** Number of workers where the user names none. */
  workers(): number;
  /** The modules beside the package's own scripts. */
  packaged(): PoolModules;
  /** Compiles the module at an address. */
  fetched(address: URL): Promise<WebAssembly.Module>;
  /** What has to be done before workers of its own script start. */
  prepare?(): Promise<void>;
  /** Starts a worker, of its own script where none is named. */
  spawn(events: WorkerEvents, source?: WorkerSource): WorkerLike;
}

/** What needs the module of drives. */
const ofDrives: readonly OperationName[] = [
  'readDrive',
  'readArray',
  'listArrays',
  'studioConfig',
  'pushDrive',
  'finishDrive',
  'simulateDrive',
  'driveScenarios',
  'scanMotion',
  'calibrateDrive',
  'jointCalibration',
  'calibrationReport',
  'mergeCalibrations',
];

/** Pieces a worker gets of a job, so that progress moves and slow pieces even out. */
const PIECES_A_WORKER = 8;
/** Pieces of a job on the calling thread, which does what else it has to do between them. */
const PIECES_HERE = 64;

/** Of the ids of what pools keep: the pools of a thread may do their work on it, where ids of two must differ. */
let lastKept = 0;

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

/** The queue and the workers; the API over it is in api.ts. */
export class Crew {
  /** Most workers at a time; 0 where the calling thread does the work. */
  readonly workers: number;
  /** Pieces of a job that can be split. */
  readonly pieces: number;
  readonly #runtime: Runtime;
  readonly #source: WorkerSource | undefined;
  readonly #limits: Limits | undefined;
  readonly #members = new Set<Member>();
  readonly #modules: Loaders;
  readonly #kept = new Map<string, Kept>();
  #here: typeof import('./here.js') | undefined;
  #queue: Task[] = [];
  #terminated = false;
  #lastId = 0;

  constructor(runtime: Runtime, options?: PoolOptions) {
    const { workers = runtime.workers(), worker, modules, limits } = checkedOptions(options);
    if (!Number.isInteger(workers) || workers < 0 || workers > 64) {
      throw failure('out-of-range', {
        what: 'workers',
        expected: 'a whole number from 0 to 64',
        given: String(workers),
      });
    }
    this.#runtime = runtime;
    this.#source = worker;
    this.workers = workers;
    this.pieces = workers === 0 ? PIECES_HERE : workers * PIECES_A_WORKER;
    // Whoever waits for a job can cancel it, unless it runs on the thread that waits.
    this.#limits = workers === 0 ? limits : { operations: Number.MAX_VALUE, ...limits };
    this.#modules = loadersOf(modules, runtime.packaged, runtime.fetched);
  }

  get #most(): number {
    return Math.max(this.workers, 1);
  }

  /** Takes a network, whose file each worker gets when it first needs it. */
  addNetwork(file: Files['network']): string {
    return this.#add({ kind: 'network', file, most: this.#most });
  }

  /** Takes a capture, which no more workers get than its size allows: the others leave its jobs to those. */
  addCapture(file: Files['capture']): string {
    const most = Math.max(1, Math.floor(COPIES_BYTES / (file.bytes.byteLength || 1)));
    return this.#add({ kind: 'capture', file, most });
  }

  /** Takes a recording that is read piece by piece, all by one worker. */
  addStream(file: Files['stream']): string {
    return this.#add({ kind: 'stream', file, most: 1 });
  }

  #add(kept: Kept): string {
    const id = `${kept.kind}-${++lastKept}`;
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
    if (this.workers === 0) this.#here ??= await import('./here.js');
    else if (this.#source === undefined) await this.#runtime.prepare?.();
    await this.#modules.core.load();
    if (pieces.some(({ name }) => ofDrives.includes(name))) await this.#modules.drives.load();
    if (needed.some(([kind]) => kind === 'network')) await this.#modules.networks.load();
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
      if (member.worker.stop) {
        member.worker.stop();
        continue;
      }
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
      let member: Member | undefined;
      try {
        member = this.#memberFor(task);
      } catch (cause) {
        task.job.reject(refused(cause instanceof Error ? cause.message : String(cause), cause));
        at = 0;
        continue;
      }
      if (member) {
        this.#queue.splice(at, 1);
        this.#give(member, task);
      } else at += 1;
    }
  }

  /** Who is free for a task: one that has what it needs, before others that would have to be given it. */
  #memberFor({ job, index }: Task): Member | undefined {
    const idle = [...this.#members].filter(({ task }) => task === undefined);
    const piece = job.pieces[index];
    const id = piece?.capture ?? piece?.stream;
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
      const drives = this.#modules.drives.module;
      if (drives && ofDrives.includes(piece.name) && !member.hasDrives) {
        member.worker.post({ drives }, []);
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
    const neural = this.#modules.networks.module;
    if (kind === 'network' && neural && !member.hasNeural) {
      member.worker.post({ neural }, []);
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
      const bytes: { byteLength: number } | undefined =
        'onnx' in file ? file.onnx : 'bytes' in file ? file.bytes : undefined;
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
    const { module } = this.#modules.core;
    if (this.#members.size >= this.#most || module === undefined) return undefined;
    const events: WorkerEvents = {
      reply: (reply) => this.#finish(member, reply),
      lost: (reason) => this.#lose(member, lost(reason)),
      refused: (reason) => this.#lose(member, refused(reason)),
    };
    const member: Member = {
      worker: this.#here?.workHere(events) ?? this.#runtime.spawn(events, this.#source),
      task: undefined,
      hasDrives: false,
      hasNeural: false,
      kept: new Set(),
    };
    this.#members.add(member);
    member.worker.post({ module }, []);
    if (this.#limits) member.worker.post({ limits: this.#limits }, []);
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

  #lose(member: Member, error: BoresightError): void {
    const task = member.task;
    if (!this.#members.has(member)) return;
    this.#dismiss(member);
    task?.job.reject(error);
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

function lost(reason: string): BoresightError {
  const details = { what: 'worker', expected: 'an answer', given: reason };
  return new BoresightError('worker-lost', `a worker was lost: ${reason}`, details);
}

function refused(reason: string, cause?: unknown): BoresightError {
  const expected = 'a host that lets its script run (worker-src of a content security policy), or `workers: 0`';
  const details = { what: 'worker', expected, given: reason };
  const message = `a worker could not be started: ${reason}; expected ${expected}`;
  return new BoresightError('worker-refused', message, details, cause === undefined ? undefined : { cause });
}

function terminated(): BoresightError {
  return failure('terminated', { what: 'worker pool', expected: 'a running pool', given: 'terminated' });
}

/** The kept files that a piece names. */
function needs({ network, capture, stream }: Piece<OperationName>): [keyof Files, string][] {
  return [
    ...(network === undefined ? [] : [network].flat().map((id) => ['network', id] as [keyof Files, string])),
    ...(capture === undefined ? [] : [['capture', capture] as [keyof Files, string]]),
    ...(stream === undefined ? [] : [['stream', stream] as [keyof Files, string]]),
  ];
}
