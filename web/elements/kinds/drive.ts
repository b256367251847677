import type { CalibrateDriveOptions, CalibrationMethod, Drive, DriveCalibration } from 'boresight';
import { Intake, type NamedBytes } from '../intake.ts';
import { MountingAngleElement } from './mounting-angle.ts';

/**
 * A drive log from its files, and the angle one of its radars is mounted at.
 *
 * @element boresight-drive
 * @attr {number} sensor - the radar; the first of the log by default
 * @attr {string} method - how the angle is estimated (recursive)
 * @attr {number} x-m - the radar's distance ahead of the rear axle, m, where the log does not state it
 * @fires boresight-result - the drive was calibrated (`detail`: the calibration)
 * @fires boresight-error - files could not be used (`detail`: the error)
 * @csspart bar - what opens files and shows progress
 */
export class DriveElement extends MountingAngleElement {
  static override get observedAttributes(): string[] {
    return [...MountingAngleElement.observedAttributes, 'sensor', 'method', 'x-m'];
  }

  #intake: Intake | undefined;
  #radars: HTMLSelectElement | undefined;
  #files: NamedBytes[] = [];
  #options: CalibrateDriveOptions | null = null;
  #drive: Drive | null = null;
  #calibration: DriveCalibration | null = null;

  /** The files: bytes with their names. */
  get files(): readonly NamedBytes[] {
    return this.#files;
  }

  set files(given: readonly NamedBytes[] | null) {
    this.#files = [...(given ?? [])];
    if (this.#intake && this.#files.length) void this.#load();
  }

  /** Options of the calibration; what attributes say goes before them. */
  get options(): CalibrateDriveOptions | null {
    return this.#options;
  }

  set options(given: CalibrateDriveOptions | null) {
    this.#options = given;
    void this.#calibrate();
  }

  /** A drive that was read or simulated already, in place of files. */
  get drive(): Drive | null {
    return this.#drive;
  }

  set drive(given: Drive | null) {
    this.#drive = given;
    if (this.#intake) this.#opened();
  }

  /** What was found. */
  get calibration(): DriveCalibration | null {
    return this.#calibration;
  }

  override connectedCallback(): void {
    super.connectedCallback();
    if (this.#drive) this.#opened();
    else if (this.#files.length) void this.#load();
  }

  override disconnectedCallback(): void {
    this.#intake?.close();
    super.disconnectedCallback();
  }

  override attributeChangedCallback(name: string): void {
    if (['sensor', 'method', 'x-m'].includes(name)) void this.#calibrate();
    else super.attributeChangedCallback(name);
  }

  /** @internal */
  protected override build(above: HTMLElement): void {
    this.#intake = new Intake(this, 'a drive', '.csv,.gz,.h5,.hdf5,.mcap,.json,.pcd', (files) => {
      this.files = files;
    });
    const radars = Object.assign(document.createElement('select'), { hidden: true });
    radars.setAttribute('aria-label', 'Radar');
    radars.addEventListener('change', () => this.setAttribute('sensor', radars.value));
    this.#radars = radars;
    this.#intake.bar.append(radars);
    above.append(this.#intake.bar);
    super.build(above);
  }

  async #load(): Promise<void> {
    const drive = await this.#intake?.run('Reading', ({ pool, signal }) =>
      pool.readDrive(this.#files, undefined, { signal }),
    );
    if (!drive || !this.isConnected) return;
    this.#drive = drive;
    this.#opened();
  }

  #opened(): void {
    const radars = this.#radars;
    const sensors = this.#drive?.sensors ?? [];
    if (radars) {
      radars.replaceChildren(...sensors.map(({ id }) => new Option(`Radar ${id}`, String(id))));
      radars.hidden = sensors.length < 2;
    }
    void this.#calibrate();
  }

  async #calibrate(): Promise<void> {
    const drive = this.#drive;
    if (!drive || !this.#intake || !this.isConnected) return;
    const given = this.#options ?? {};
    const sensor = this.numberOf('sensor', given.sensor ?? drive.sensors[0]?.id ?? 0);
    if (this.#radars) this.#radars.value = String(sensor);
    const method = (this.getAttribute('method') ?? given.method ?? 'recursive') as CalibrationMethod;
    const xM = this.numberOf('x-m', Number.NaN);
    const options = { ...given, sensor, method, ...(Number.isFinite(xM) ? { xM } : {}) };
    const found = await this.#intake.run('Calibrating', ({ pool, signal, onProgress }) =>
      pool.calibrateDrive(drive, options, { signal, onProgress }),
    );
    if (!found) return;
    this.#calibration = found;
    const nominal = found.mounting.nominalDeg;
    if (nominal !== null && !this.hasAttribute('nominal-deg')) this.setAttribute('nominal-deg', String(nominal));
    this.history = found.history;
    this.tell('boresight-result', found);
  }
}
