import {
  type BoardCounts,
  type BoardFrame,
  type BoardPort,
  boardFrames,
  init,
  replayBytes,
  serialBytes,
} from 'boresight';
import { count } from '../../plots/format.ts';
import type { Drawing } from '../base/drawing.ts';
import { Intake, type NamedBytes } from '../intake.ts';
import { type PointCloud, PointCloudElement } from './point-cloud.ts';

/** A board's detections as columns. */
export function pointsOf({ objects }: BoardFrame): PointCloud {
  return {
    rangeM: objects.map(({ rangeM }) => rangeM),
    azimuthDeg: objects.map(({ azimuthDeg }) => azimuthDeg),
    // Boards that see no elevation send zeros.
    elevationDeg: objects.some(({ zM }) => zM !== 0) ? objects.map(({ elevationDeg }) => elevationDeg) : null,
    rangeRateMps: objects.some(({ rateMps }) => rateMps === null) ? null : objects.map(({ rateMps }) => rateMps ?? 0),
  };
}

/**
 * What a TI board detects, live: from its data port, from bytes of one's own, or from a recording (`.dat`, with `.cfg`) as it
 * was made.
 *
 * @element boresight-board
 * @attr {number} baud-rate - of the port (921600)
 * @attr {number} rate - times the speed of the port at which a recording is replayed; 0 for as fast as can be
 * @fires boresight-frame - a frame came (`detail`: the frame)
 * @fires boresight-error - the source or the files could not be used (`detail`: the error)
 * @csspart bar - what opens files and tells of problems
 */
export class BoardElement extends PointCloudElement {
  static override get observedAttributes(): string[] {
    return [...PointCloudElement.observedAttributes, 'baud-rate', 'rate'];
  }

  #intake: Intake | undefined;
  #files: NamedBytes[] = [];
  #source: AsyncIterable<Uint8Array> | null = null;
  #port: BoardPort | null = null;
  #config: string | null = null;
  #running: AbortController | null = null;
  #counts: (() => BoardCounts) | null = null;

  /** The files of a recording: bytes with their names. */
  get files(): readonly NamedBytes[] {
    return this.#files;
  }

  set files(given: readonly NamedBytes[] | null) {
    this.#files = [...(given ?? [])];
    if (this.#files.length) this.#restart();
  }

  /** Bytes of a data port as they come, of whatever origin; `null` ends what runs. */
  get source(): AsyncIterable<Uint8Array> | null {
    return this.#source;
  }

  set source(given: AsyncIterable<Uint8Array> | null) {
    this.#source = given || null;
    this.#restart();
  }

  /** The data port, as Web Serial gives it; the element opens and closes it. */
  get port(): BoardPort | null {
    return this.#port;
  }

  set port(given: BoardPort | null) {
    this.#port = given || null;
    this.#restart();
  }

  /** The text of the configuration that the board runs; it tells range rates. */
  get config(): string | null {
    return this.#config;
  }

  set config(given: string | null) {
    this.#config = given || null;
  }

  /** What came so far, and what was lost. */
  get counts(): BoardCounts | null {
    return this.#counts?.() ?? null;
  }

  override connectedCallback(): void {
    super.connectedCallback();
    this.#restart();
  }

  override disconnectedCallback(): void {
    this.stop();
    this.#intake?.close();
    super.disconnectedCallback();
  }

  /** Ends what runs; the last frame stays. */
  stop(): void {
    this.#running?.abort();
    this.#running = null;
  }

  /** @internal */
  protected override build(above: HTMLElement): void {
    this.#intake = new Intake(this, 'a recording', '.dat,.cfg', (files) => {
      this.files = files;
    });
    above.append(this.#intake.bar);
    super.build(above);
  }

  /** @internal */
  protected override draw(): Drawing | null {
    const drawing = super.draw();
    const told = this.#counts?.();
    if (!drawing || !told) return drawing;
    const lost = told.damagedPackets ? `; damaged packets: ${count(told.damagedPackets)}` : '';
    const said = `${this.#running ? 'Live, ' : ''}${count(told.frames)} frames${lost}.`;
    return { ...drawing, alternative: `${said} ${drawing.alternative ?? ''}` };
  }

  #restart(): void {
    this.stop();
    if (!this.#intake || !this.isConnected) return;
    const controller = new AbortController();
    const { signal } = controller;
    const recording = this.#files.find(({ name }) => /\.dat$/i.test(name));
    const source = this.#opened(recording, signal);
    if (!source) {
      if (this.#files.length && !recording)
        this.#intake.fail(new Error('A recording is the .dat of a board; its .cfg may come with it.'));
      return;
    }
    this.#running = controller;
    this.#intake.stop();
    void this.#run(source, controller).catch((problem: unknown) => {
      if (!signal.aborted) this.#intake?.fail(problem);
    });
  }

  /** What goes before: a source, a port, files. */
  #opened(recording: NamedBytes | undefined, signal: AbortSignal): AsyncIterable<Uint8Array> | null {
    if (this.#source) return this.#source;
    if (this.#port) return serialBytes(this.#port, { baudRate: this.numberOf('baud-rate', 921_600), signal });
    const rate = this.numberOf('rate', 1);
    return recording
      ? replayBytes(recording.bytes, { rate: rate > 0 ? rate : Number.POSITIVE_INFINITY, signal })
      : null;
  }

  async #run(source: AsyncIterable<Uint8Array>, mine: AbortController): Promise<void> {
    await init();
    const file = this.#files.find(({ name }) => /\.cfg$/i.test(name));
    const config = this.#config ?? (file ? new TextDecoder().decode(file.bytes) : undefined);
    const frames = boardFrames(source, config);
    this.#counts = () => frames.counts;
    try {
      for await (const frame of frames) {
        if (mine.signal.aborted) return;
        this.points = pointsOf(frame);
        this.tell('boresight-frame', frame);
      }
    } finally {
      if (this.#running === mine) {
        this.#running = null;
        this.changed();
      }
    }
  }
}
