import type { CaptureInfo, ChainOptions } from 'boresight';
import type { PoolCapture } from 'boresight/worker';
import { Intake, type NamedBytes } from '../intake.ts';
import { RangeDopplerElement } from './range-doppler.ts';

/**
 * A raw capture from its files (`.bin` with `.cfg` or the JSON of mmWave Studio), frame by frame.
 *
 * @element boresight-capture
 * @attr {number} frame - the frame shown, from 0
 * @attr {string} method - how angles of its detections are estimated
 * @fires boresight-result - a frame was processed (`detail`: its result)
 * @fires boresight-error - files or a frame could not be used (`detail`: the error)
 * @csspart bar - what opens files and shows progress
 */
export class CaptureElement extends RangeDopplerElement {
  static override get observedAttributes(): string[] {
    return [...RangeDopplerElement.observedAttributes, 'frame', 'method'];
  }

  #intake: Intake | undefined;
  #slider: HTMLInputElement | undefined;
  #files: NamedBytes[] = [];
  #options: ChainOptions | null = null;
  #capture: PoolCapture | null = null;

  /** The files: bytes with their names. */
  get files(): readonly NamedBytes[] {
    return this.#files;
  }

  set files(given: readonly NamedBytes[] | null) {
    this.#files = [...(given ?? [])];
    if (this.#intake && this.#files.length) void this.#load();
  }

  /** Options of the chain from frames to detections; the attribute `method` goes before their method. */
  get options(): ChainOptions | null {
    return this.#options;
  }

  set options(given: ChainOptions | null) {
    this.#options = given;
    void this.#process();
  }

  /** What is known of the capture that is open. */
  get info(): CaptureInfo | null {
    return this.#capture?.info ?? null;
  }

  override connectedCallback(): void {
    super.connectedCallback();
    if (this.#files.length && !this.#capture) void this.#load();
  }

  override disconnectedCallback(): void {
    this.#capture?.free();
    this.#capture = null;
    this.#intake?.close();
    super.disconnectedCallback();
  }

  override attributeChangedCallback(name: string): void {
    if (name === 'frame' || name === 'method') void this.#process();
    else super.attributeChangedCallback(name);
  }

  /** @internal */
  protected override build(above: HTMLElement): void {
    this.#intake = new Intake(this, 'a capture', '.bin,.cfg,.json', (files) => {
      this.files = files;
    });
    const slider = Object.assign(document.createElement('input'), { type: 'range', min: '0', step: '1', hidden: true });
    slider.setAttribute('aria-label', 'Frame');
    slider.addEventListener('input', () => this.setAttribute('frame', slider.value));
    this.#slider = slider;
    this.#intake.bar.append(slider);
    above.append(this.#intake.bar);
  }

  async #load(): Promise<void> {
    const intake = this.#intake;
    if (!intake) return;
    const config = this.#files.find(({ name }) => /\.(cfg|json)$/i.test(name));
    const data = this.#files.find((file) => file !== config);
    if (!config || !data) {
      intake.fail(new Error('A capture is a .bin file and the .cfg or .json of the board that made it.'));
      return;
    }
    this.#capture?.free();
    this.#capture = null;
    const capture = await intake.run('Reading', ({ pool, signal }) =>
      pool.loadCapture(data.bytes, new TextDecoder().decode(config.bytes), { signal }),
    );
    if (!capture) return;
    if (!this.isConnected) {
      capture.free();
      return;
    }
    this.#capture = capture;
    if (this.#slider) {
      this.#slider.max = String(capture.info.frames - 1);
      this.#slider.hidden = capture.info.frames < 2;
    }
    await this.#process();
  }

  async #process(): Promise<void> {
    const capture = this.#capture;
    if (!capture) return;
    const frame = Math.min(Math.max(Math.round(this.numberOf('frame', 0)), 0), capture.info.frames - 1);
    if (this.#slider) this.#slider.value = String(frame);
    const method = this.getAttribute('method');
    const given = this.#options ?? {};
    const options = method ? { ...given, angle: { ...given.angle, method: method as 'capon' } } : given;
    const result = await this.#intake?.run(`Frame ${frame + 1} of ${capture.info.frames}`, ({ signal }) =>
      capture.processFrame(frame, options, { signal }),
    );
    if (!result) return;
    this.frame = result;
    this.tell('boresight-result', result);
  }
}
