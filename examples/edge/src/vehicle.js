/** A vehicle: the calibrations of its radars, in a storage that outlives the process. */
import { initDrives } from 'boresight';
import { bytesOf, checkType, parsed, pieces } from './body.js';
import { Bucket } from './bucket.js';
import { frameOf, isObject } from './frame.js';
import { Lines } from './lines.js';
import { Radar } from './radar.js';
import {
  isBoresightError,
  isOurs,
  isRefusal,
  json,
  notStored,
  Problem,
  problemOf,
  refusal,
  unreadable,
  wrongType,
} from './reply.js';
import { pack, unpack } from './storage/pack.js';

/** A fleet is told at most so often. */
const TELL_MS = 5000;
const DAY_MS = 86_400_000;
/** Lines of a request whose problems are told; the others are counted. */
const TOLD = 20;

/** @param {Uint8Array} line */
const isBlank = (line) => line.every((byte) => byte === 32 || byte === 9 || byte === 13);

/** @typedef {{ tenant: string, vehicle: string, radar?: string, action: keyof typeof actions }} Ask */
/** @typedef {{ accepted: number, repeated: number, refused: number, problems: unknown[] }} Tally */
/** @typedef {{ tenant: string, vehicle: string, receivedMs: number, refused: Record<string, number> }} Head */
/** @typedef {Pick<import('./fleet.js').Fleet, 'admit' | 'tell' | 'quarantine' | 'forget'>} FleetPort */

export class Vehicle {
  #storage;
  #config;
  #fleetOf;
  #now;
  #lines;
  /** What is kept, as far as it is in memory. @type {{ head: Head | null, radars: Map<string, Radar> } | null} */
  #state = null;
  #toldMs = 0;
  /** @type {number | null | undefined} */
  #alarmMs;
  /** The last write, whatever becomes of it. @type {Promise<void>} */
  #written = Promise.resolve();
  /** The code that was last reported. @type {string | null} */
  #toldQuarantine = null;
  /** Code of what is wrong with the stored data, which nothing is written over. @type {string | null} */
  quarantined = null;

  /**
   * @param {import('./storage/storage.js').Storage} storage
   * @param {import('./config.js').Config} config
   * @param {(tenant: string) => FleetPort | Promise<FleetPort>} fleetOf
   * @param {() => number} [now]
   */
  constructor(storage, config, fleetOf, now = Date.now) {
    this.#storage = storage;
    this.#config = config;
    this.#fleetOf = fleetOf;
    this.#now = now;
    this.#lines = new Bucket(config.limits.frames, now());
  }

  /**
   * Answers what the handler passes on.
   *
   * @param {Ask} ask
   * @param {Request} request
   */
  async answer(ask, request) {
    try {
      await initDrives();
      return await actions[ask.action](this, ask, request);
    } catch (error) {
      if (error instanceof Problem && error.code === this.quarantined) await this.#tellQuarantine(ask, error);
      return refusal(error);
    }
  }

  /** What is due at a time that was set before: telling the fleet, or forgetting. */
  async alarm() {
    await initDrives();
    this.#alarmMs = null;
    const head = this.#headOrNone();
    if (!head) return;
    if (this.#now() >= head.receivedMs + this.#config.retentionDays * DAY_MS) await this.forget(head);
    else await this.#tell(head);
  }

  /** Gives back what it has in memory; all of it is kept. */
  rest() {
    for (const radar of this.#state?.radars.values() ?? []) radar.free();
    this.#state = null;
  }

  /** @param {Ask} ask */
  describe({ vehicle }) {
    return this.#steadily(() => {
      const { head, radars } = this.#known();
      const { receivedMs, refused } = head;
      return json({ vehicle, receivedMs, refused, radars: [...radars.values()].map((radar) => radar.describe()) });
    });
  }

  /**
   * Takes the frames of a body. What an answer counts as accepted is kept.
   *
   * @param {Request} request
   */
  async take(request) {
    const { limits } = this.#config;
    checkType(request, ['application/x-ndjson', 'application/jsonl']);
    this.#known();
    const lines = new Lines(limits.lineBytes);
    /** @type {Tally} */
    const tally = { accepted: 0, repeated: 0, refused: 0, problems: [] };
    try {
      for await (const piece of pieces(request, limits.idleS)) {
        await this.#takeLines(lines.push(piece), tally);
        await this.#tellSoon(false);
      }
      await this.#takeLines(lines.end(), tally);
    } catch (error) {
      const problem = problemOf(error);
      problem.also.stored = tally;
      throw problem;
    } finally {
      await this.#tellSoon(true).catch((error) => console.error(error));
    }
    const radars = await this.#steadily(() => this.#summaries());
    const status = tally.refused > 0 && tally.accepted + tally.repeated === 0 ? 422 : 200;
    return json({ ...tally, radars }, status);
  }

  /** @param {Ask} ask @param {Request} request */
  async configure({ tenant, vehicle, radar: name = '' }, request) {
    checkType(request, ['application/json']);
    this.#load();
    const given = parsed(await bytesOf(request, 1 << 16, this.#config.limits.idleS), 'the options');
    if (!isObject(given)) throw wrongType('the options', 'an object', given);
    const { method = 'recursive', ...rest } = given;
    if (method !== 'recursive') {
      const expected = 'recursive, the method that goes on from frame to frame';
      throw new Problem(422, 'unsuited-method', { what: 'method', expected, given: String(method).slice(0, 64) });
    }
    const made = Radar.begin(name, /** @type {any} */ ({ method, ...rest }));
    let begun = false;
    try {
      const most = this.#config.tenants[tenant]?.vehicles ?? 1000;
      const admitted = async () => (await this.#fleetOf(tenant)).admit(vehicle, most);
      if (!this.#load().head && !(await this.#stored(admitted))) {
        throw new Problem(409, 'too-many', { what: 'vehicles', expected: `${most} at most`, given: 'one more' });
      }
      // Nothing waits from here on.
      const { head, radars } = this.#load();
      const before = radars.get(name);
      if (before && JSON.stringify(before.options) !== JSON.stringify(made.options)) {
        const expected = 'the options that it was begun with; delete it to begin anew';
        throw new Problem(409, 'exists', { what: `radar ${name}`, expected, given: 'others' });
      }
      if (!before && radars.size >= this.#config.limits.radars) {
        const expected = `${this.#config.limits.radars} at most`;
        throw new Problem(409, 'too-many', { what: 'radars', expected, given: 'one more' });
      }
      const radar = before ?? made;
      if (!before) radars.set(name, made);
      begun = !before;
      await this.#commit(head ?? { tenant, vehicle, receivedMs: this.#now(), refused: {} });
      await this.#tellSoon(true);
      return json(radar.summary(), begun ? 201 : 200);
    } finally {
      if (!begun) made.free();
    }
  }

  /** @param {Ask} ask */
  async forgetRadar({ radar: name = '' }) {
    const { head, radars } = this.#known();
    const radar = radars.get(name);
    if (!radar) throw new Problem(404, 'not-found', { what: 'radar', expected: 'one of the vehicle', given: name });
    radars.delete(name);
    try {
      await this.#stored(() =>
        this.#storage.write([
          [`radar/${name}`, null],
          [`history/${name}`, null],
        ]),
      );
    } catch (error) {
      // It is still stored, unless another one was begun.
      if (this.#state?.radars === radars && !radars.has(name)) radars.set(name, radar);
      else radar.free();
      throw error;
    }
    radar.free();
    await this.#tell(head);
    return new Response(null, { status: 204 });
  }

  /** @param {Pick<Ask, 'tenant' | 'vehicle'>} ask */
  async forget({ tenant, vehicle }) {
    const before = this.#load();
    const empty = { head: null, radars: new Map() };
    this.#state = empty;
    this.#alarmMs = undefined;
    this.#toldMs = 0;
    try {
      await this.#stored(() => this.#storage.clear());
    } catch (error) {
      // It is still stored, unless another one was begun.
      if (this.#state === empty && empty.radars.size === 0) this.#state = before;
      throw error;
    }
    for (const radar of before.radars.values()) radar.free();
    const listed = await this.#stored(async () => (await this.#fleetOf(tenant)).forget(vehicle));
    if (!before.head && !listed)
      throw new Problem(404, 'not-found', { what: 'vehicle', expected: 'a known one', given: vehicle });
    return new Response(null, { status: 204 });
  }

  /** @param {ReturnType<Lines['push']>} given @param {Tally} tally */
  async #takeLines(given, tally) {
    const lines = given.filter(({ bytes }) => !bytes || !isBlank(bytes));
    if (lines.length === 0) return;
    this.#lines.take(lines.length, this.#now(), 'frames of the vehicle');
    /** Lines at which boresight stopped: the rest is taken without them. @type {Set<number>} */
    const fatal = new Set();
    const counted = await this.#steadily(async () => {
      const { tally, kept } = this.#takeAtOnce(lines, fatal);
      await kept;
      return tally;
    });
    tally.accepted += counted.accepted;
    tally.repeated += counted.repeated;
    tally.refused += counted.refused;
    tally.problems.push(...counted.problems.slice(0, TOLD - tally.problems.length));
  }

  /**
   * Does something with the calibrations. Where boresight stopped, they are restored from what is kept, and it is done again.
   *
   * @template T
   * @param {() => T | Promise<T>} work
   * @returns {Promise<T>}
   */
  async #steadily(work) {
    for (let left = 8; ; left--) {
      try {
        return await work();
      } catch (error) {
        if (left === 0 || !isBoresightError(error) || !['trap', 'handle-stale'].includes(error.code)) throw error;
        const stopped = this.#state;
        await this.#written;
        // Another request may have brought them back meanwhile.
        if (this.#state === stopped) this.rest();
        await initDrives();
      }
    }
  }

  /**
   * Takes lines with no other request in between, and has what came of them kept: all of it or nothing.
   *
   * @param {ReturnType<Lines['push']>} lines
   * @param {Set<number>} fatal
   */
  #takeAtOnce(lines, fatal) {
    const { head, radars } = this.#known();
    const refused = { ...head.refused };
    /** @type {Tally} */
    const tally = { accepted: 0, repeated: 0, refused: 0, problems: [] };
    for (const line of lines) {
      /** @type {Radar | undefined} */
      let radar;
      try {
        const read = this.#read(line, radars, fatal);
        radar = read.radar;
        tally[radar.add(read.frame, this.#config.limits)] += 1;
      } catch (error) {
        if (isBoresightError(error) && error.code === 'trap') fatal.add(line.number);
        if (!isRefusal(error)) throw error;
        const problem = problemOf(error);
        const counts = radar?.refused ?? refused;
        counts[problem.code] = (counts[problem.code] ?? 0) + 1;
        tally.refused += 1;
        if (tally.problems.length < TOLD) tally.problems.push({ line: line.number, ...problem.toJSON() });
      }
    }
    return { tally, kept: this.#commit({ ...head, receivedMs: this.#now(), refused }) };
  }

  /**
   * The frame on a line with its radar.
   *
   * @param {{ number: number, bytes?: Uint8Array }} line
   * @param {Map<string, Radar>} radars
   * @param {Set<number>} fatal
   */
  #read({ number, bytes }, radars, fatal) {
    const { limits } = this.#config;
    if (!bytes) {
      const details = { what: 'the line', expected: `${limits.lineBytes} bytes at most`, given: 'more' };
      throw new Problem(413, 'line-too-long', details);
    }
    if (fatal.has(number)) {
      throw new Problem(422, 'trap', { what: 'the frame', expected: 'one that can be worked out', given: 'another' });
    }
    const { radar: name, frame } = frameOf(parsed(bytes, 'the line'), limits);
    const radar = typeof name === 'string' ? radars.get(name) : undefined;
    if (radar) return { radar, frame };
    const expected = `one of ${radars.size} that are configured`;
    const given = typeof name === 'string' ? name.slice(0, 64) : typeof name;
    throw new Problem(422, 'unknown-radar', { what: 'frame.radar', expected, given });
  }

  /** What is kept of the vehicle, brought into memory. */
  #load() {
    if (this.#state) return this.#state;
    /** @type {Map<string, Radar>} */
    const radars = new Map();
    try {
      const kept = this.#storage.read();
      const head = kept.get('vehicle');
      for (const [key, state] of kept) {
        if (!key.startsWith('radar/')) continue;
        const name = key.slice('radar/'.length);
        radars.set(name, Radar.restore(name, state, kept.get(`history/${name}`)));
      }
      this.#state = { head: head ? /** @type {[Head]} */ (unpack(head))[0] : null, radars };
    } catch (error) {
      for (const radar of radars.values()) radar.free();
      if (isOurs(error)) throw error;
      const problem = unreadable('the stored data of the vehicle', error);
      this.quarantined = problem.code;
      throw problem;
    }
    this.quarantined = null;
    this.#toldQuarantine = null;
    return this.#state;
  }

  /** The head, or nothing where there is none or it cannot be read. */
  #headOrNone() {
    try {
      return this.#load().head;
    } catch (error) {
      if (this.quarantined) return null;
      throw error;
    }
  }

  /** Lists the vehicle as quarantined. @param {Ask} ask @param {Problem} problem */
  async #tellQuarantine({ tenant, vehicle }, { code, message }) {
    if (this.#toldQuarantine === code) return;
    this.#toldQuarantine = code;
    console.error(`vehicle ${vehicle} of tenant ${tenant}: ${message} (${code})`);
    try {
      await (await this.#fleetOf(tenant)).quarantine(vehicle, code);
    } catch (error) {
      console.error(error);
    }
  }

  #known() {
    const { head, radars } = this.#load();
    if (head) return { head, radars };
    const expected = 'one with a radar; put one first';
    throw new Problem(404, 'not-found', { what: 'vehicle', expected, given: 'an unknown one' });
  }

  #summaries() {
    return [...this.#load().radars.values()].map((radar) => radar.summary());
  }

  /** Keeps what changed. Where that fails, it is kept with what changes next. @param {Head} head */
  #commit(head) {
    const state = this.#load();
    const before = state.head;
    const radars = [...state.radars.values()];
    const changes = radars.flatMap((radar) => radar.kept());
    for (const radar of radars) radar.settle(true);
    state.head = head;
    const written = (async () => this.#storage.write([['vehicle', pack(head)], ...changes]))();
    const settled = written.catch(() => {
      for (const radar of radars) radar.settle(false);
      // A vehicle is there once it is stored, by this or by a later write.
      if (!before && this.#written === settled) state.head = null;
    });
    this.#written = settled;
    return this.#stored(() => written);
  }

  /**
   * Waits for something to be stored, or throws what is answered where it is not.
   *
   * @template T
   * @param {() => T | Promise<T>} write
   * @returns {Promise<T>}
   */
  async #stored(write) {
    try {
      return await write();
    } catch (error) {
      if (error instanceof Problem) throw error;
      console.error(error);
      throw notStored();
    }
  }

  /** Tells the fleet now, if that was not done lately; else a little later, where `later` says so. @param {boolean} later */
  async #tellSoon(later) {
    const head = this.#headOrNone();
    if (!head) return;
    const dueMs = this.#toldMs + TELL_MS;
    if (this.#now() >= dueMs) await this.#tell(head);
    else if (later) await this.#wake(dueMs);
  }

  /** @param {Head} head */
  async #tell(head) {
    this.#toldMs = this.#now();
    const { tenant, vehicle, receivedMs, refused } = head;
    const radars = await this.#steadily(() => this.#summaries());
    let nextMs = receivedMs + this.#config.retentionDays * DAY_MS;
    try {
      await (await this.#fleetOf(tenant)).tell(vehicle, { receivedMs, refused, radars });
    } catch (error) {
      // A list that cannot be read was reported when it was found.
      if (!(error instanceof Problem)) console.error(error);
      nextMs = this.#now() + TELL_MS;
    }
    await this.#wake(nextMs);
  }

  /** Sets the alarm, unless it comes before. @param {number} atMs */
  async #wake(atMs) {
    try {
      if (this.#alarmMs === undefined) this.#alarmMs = await this.#storage.alarm();
      if (this.#alarmMs !== null && this.#alarmMs <= atMs) return;
      this.#alarmMs = atMs;
      await this.#storage.setAlarm(atMs);
    } catch (error) {
      // It is set when the fleet is told next.
      console.error(error);
      this.#alarmMs = undefined;
    }
  }
}

/** What can be asked of a vehicle. */
const actions = {
  /** @param {Vehicle} vehicle @param {Ask} ask */
  describe: (vehicle, ask) => vehicle.describe(ask),
  /** @param {Vehicle} vehicle @param {Ask} _ @param {Request} request */
  take: (vehicle, _, request) => vehicle.take(request),
  /** @param {Vehicle} vehicle @param {Ask} ask @param {Request} request */
  configure: (vehicle, ask, request) => vehicle.configure(ask, request),
  /** @param {Vehicle} vehicle @param {Ask} ask */
  forgetRadar: (vehicle, ask) => vehicle.forgetRadar(ask),
  /** @param {Vehicle} vehicle @param {Ask} ask */
  forget: (vehicle, ask) => vehicle.forget(ask),
};
