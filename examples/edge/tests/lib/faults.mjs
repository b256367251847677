/** Storages that fail at the n-th call, after the manner of SQLite's anomaly tests: a disk in memory, and a database. */
import { basename } from 'node:path';

const failure = (code) => Object.assign(new Error(`${code}: injected`), { code });

/**
 * What goes wrong: an error once or from then on, a part written of what was to be written, or a power cut before the call.
 * `calls` limits it to calls of that name.
 */
export const FAULTS = [
  ...['ENOSPC', 'EIO', 'EINTR'].flatMap((code) => [
    { code, lasts: false },
    { code, lasts: true },
  ]),
  { short: true, calls: 'write' },
  { short: true, code: 'ENOSPC', lasts: true, calls: 'write' },
  { cut: true },
];

/** Counts calls, and has the n-th one fail. */
class Trigger {
  calls = 0;
  /** Whether the fault came. */
  hit = false;
  #fault;
  #at;

  constructor(fault, at) {
    this.#fault = fault;
    this.#at = at;
  }

  /** The fault of a call, where there is one. */
  next(name) {
    if (this.isCut) return { cut: true };
    const { calls, short, cut, code, lasts } = this.#fault ?? {};
    if (!this.#fault || (calls && calls !== name && !this.hit)) return undefined;
    this.calls += 1;
    if (this.calls < this.#at || (this.calls > this.#at && !lasts)) return undefined;
    const first = !this.hit;
    this.hit = true;
    if (cut) this.isCut = true;
    return { cut, short: short && first, code: short && first ? undefined : code };
  }

  heal() {
    this.#fault = undefined;
  }
}

/**
 * The functions of node:fs that files.js uses, on one folder in memory. What was written, and what a name is of, is in
 * memory until it is synchronised; a power cut takes any of it.
 */
export class MemoryDisk {
  #files = new Map();
  #kept = new Map();
  #trigger = new Trigger();

  /** Has the n-th call from now on fail. */
  inject(fault, at) {
    this.#trigger = new Trigger(fault, at);
    return this.#trigger;
  }

  #call(name) {
    const fault = this.#trigger.next(name);
    if (fault?.cut) throw failure('the power is cut');
    if (fault?.code) throw failure(fault.code);
    return fault?.short;
  }

  #file(path) {
    const file = this.#files.get(basename(path));
    if (!file) throw failure('ENOENT');
    return file;
  }

  makeFolder = () => void this.#call('makeFolder');
  readdirSync = () => {
    this.#call('readdir');
    return [...this.#files.keys()];
  };
  readFileSync = (path) => {
    this.#call('readFile');
    return this.#file(path).bytes.slice();
  };
  rmSync = (path) => {
    this.#call('rm');
    this.#file(path);
    this.#files.delete(basename(path));
  };
  rm = async (path) => {
    this.#call('rm');
    this.#files.delete(basename(path));
  };
  rename = async (from, to) => {
    this.#call('rename');
    this.#files.set(basename(to), this.#file(from));
    this.#files.delete(basename(from));
  };
  open = async (path, flags) => {
    this.#call('open');
    const isFolder = flags === 'r';
    if (!isFolder) {
      const file = this.#files.get(basename(path)) ?? { kept: new Uint8Array() };
      file.bytes = new Uint8Array();
      file.synced = false;
      this.#files.set(basename(path), file);
    }
    const file = this.#files.get(basename(path));
    return {
      write: async (bytes, at, length) => {
        const bytesWritten = this.#call('write') ? length >> 1 : length;
        const longer = new Uint8Array(file.bytes.length + bytesWritten);
        longer.set(file.bytes);
        longer.set(bytes.subarray(at, at + bytesWritten), file.bytes.length);
        file.bytes = longer;
        file.synced = false;
        return { bytesWritten };
      },
      sync: async () => {
        this.#call('sync');
        if (isFolder) this.#kept = new Map(this.#files);
        else Object.assign(file, { kept: file.bytes.slice(), synced: true });
      },
      close: async () => void this.#call('close'),
    };
  };

  /** The disk after a power cut; `random` draws what is there of what was not synchronised. */
  afterCut({ one, next }) {
    const after = new MemoryDisk();
    const copies = new Map();
    const copy = (file) => {
      const torn = file.bytes.slice(0, Math.floor(next() * file.bytes.length));
      const bytes = file.synced ? file.kept : one([file.kept, file.bytes, torn]);
      if (!copies.has(file)) copies.set(file, { bytes: bytes.slice(), kept: bytes.slice(), synced: true });
      return copies.get(file);
    };
    for (const name of new Set([...this.#files.keys(), ...this.#kept.keys()])) {
      const file = one([this.#files, this.#kept]).get(name);
      if (file) after.#files.set(name, copy(file));
    }
    after.#kept = new Map(after.#files);
    return after;
  }
}

/** An open SQLite whose n-th call fails, before it does anything or, for a commit, after it was rolled back. */
export class FaultyDatabase {
  #db;
  #trigger = new Trigger();

  constructor(db) {
    this.#db = db;
  }

  inject(fault, at) {
    this.#trigger = new Trigger(fault, at);
    return this.#trigger;
  }

  #call(name, work, undo = (_code) => {}) {
    const fault = this.#trigger.next(name);
    if (!fault) return work();
    undo(fault.code);
    throw failure(fault.code ?? 'EIO');
  }

  exec(sql) {
    // SQLite rolls back by itself where a disk is full, and a rollback ends the transaction whatever it reports.
    const undo = (code) => {
      if (sql === 'ROLLBACK' || (sql === 'COMMIT' && code === 'ENOSPC')) this.#db.exec('ROLLBACK');
    };
    return this.#call('exec', () => this.#db.exec(sql), undo);
  }

  prepare(sql) {
    const statement = this.#db.prepare(sql);
    return Object.fromEntries(
      ['run', 'get', 'all'].map((name) => [name, (...given) => this.#call(name, () => statement[name](...given))]),
    );
  }
}

/** What an object may hold, given which of its writes were acknowledged. */
export class Expected {
  #states = [''];

  /** Says that a write was begun and acknowledged, or that it failed, which leaves it open whether it was done. */
  add(apply, acknowledged) {
    const after = this.#states.map((state) => apply(state));
    this.#states = [...new Set(acknowledged ? after : [...this.#states, ...after])];
  }

  allows(state) {
    return this.#states.includes(state);
  }
}
