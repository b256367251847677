/**
 * The JSON that mmWave Studio writes (.mmwave.json, and .setup.json for the board), as the text of a .cfg, which the
 * package reads. Names of fields are those of TI's mmWaveLink.
 */
import { api, FileProblem } from '../../../data.ts';

/** A part of the file with the way to it. */
class Part {
  readonly file: string;
  readonly path: string;
  readonly value: unknown;

  constructor(file: string, path: string, value: unknown) {
    this.file = file;
    this.path = path;
    this.value = value;
  }

  fail(expected: string, given = shown(this.value)): never {
    throw new FileProblem('config-value', this.file, `${this.path || 'the file'} is ${given}; expected ${expected}`);
  }

  /** What stands under a name, if anything does. */
  at(...names: readonly string[]): Part {
    return names.reduce<Part>((part, name) => {
      const { value } = part;
      const inner = typeof value === 'object' && value !== null && !Array.isArray(value) && Object.hasOwn(value, name);
      const path = part.path ? `${part.path}.${name}` : name;
      return new Part(part.file, path, inner ? (value as Record<string, unknown>)[name] : undefined);
    }, this);
  }

  get there(): boolean {
    return this.value !== undefined && this.value !== null;
  }

  list(expected: string): Part[] {
    if (!Array.isArray(this.value) || !this.value.length)
      return this.fail(expected, this.there ? undefined : 'missing');
    return this.value.map((one, i) => new Part(this.file, `${this.path}[${i}]`, one));
  }

  /** A number; masks are written as hexadecimal texts. */
  number(): number {
    const { value } = this;
    if (!this.there) return this.fail('a number', 'missing');
    const number = typeof value === 'string' && value.trim() !== '' ? Number(value) : value;
    return typeof number === 'number' && Number.isFinite(number) ? number : this.fail('a number');
  }

  /** Refuses what is there with another value than one that can be read. */
  only(allowed: readonly (number | string)[], meaning: string): void {
    if (!this.there) return;
    const fits = allowed.some((one) => (typeof one === 'number' ? this.number() === one : this.value === one));
    if (!fits) this.fail(meaning);
  }
}

function shown(value: unknown): string {
  if (value === undefined) return 'missing';
  const text = JSON.stringify(value);
  return text.length > 40 ? `${text.slice(0, 40)}…` : text;
}

function opened(file: string, text: string): Part {
  let value: unknown;
  try {
    value = JSON.parse(text);
  } catch {
    throw new FileProblem('config-value', file, 'is no JSON; expected what mmWave Studio writes');
  }
  return new Part(file, '', value);
}

export const isStudio = (name: string): boolean => /\.json$/i.test(name);
export const isSetup = (name: string): boolean => /\.setup\.json$/i.test(name);

export interface TextFile {
  name: string;
  text: string;
}

/** A line of the .cfg and what of the JSON it comes from. */
interface Line {
  text: string;
  from: string;
}

/** The text of a .cfg that says what the JSON does; throws, with the field's name, where that cannot be read. */
export function configOfStudio(mmwave: TextFile, setup: TextFile | null): string {
  const platform = setup ? platformOf(setup) : null;
  const lines = [...(platform ? [platform] : []), ...linesOf(opened(mmwave.name, mmwave.text))];
  const text = `${lines.map((line) => line.text).join('\n')}\n`;
  try {
    api.parseConfig(text);
  } catch (error) {
    if (!(error instanceof api.BoresightError)) throw error;
    // The package names a line of a text that the user has not got.
    const [, number, , what = ''] = /^line (\d+): (\w+): (.*)$/.exec(error.details.what ?? '') ?? [];
    const from = lines[Number(number) - 1]?.from;
    if (!from) throw error;
    const { given, expected } = error.details;
    throw new FileProblem(error.code, mmwave.name, `${from}: ${what} is ${given}; expected ${expected}`);
  }
  return text;
}

function platformOf({ name, text }: TextFile): Line {
  const device = opened(name, text).at('mmWaveDevice');
  if (typeof device.value !== 'string' || !/^[a-z]{3}\d{4}\w*$/i.test(device.value))
    return device.fail('the name of a device, such as "awr1843"');
  return { text: `% Platform:${device.value}`, from: device.path };
}

function linesOf(file: Part): Line[] {
  const devices = file.at('mmWaveDevices').list('a device, as mmWave Studio writes it in .mmwave.json');
  for (const one of devices) {
    const rf = one.at('rfConfig');
    rf.at('waveformType').only(['legacyFrameChirp'], '"legacyFrameChirp": frames of chirps that are all alike');
    rf.at('MIMOScheme').only(['TDM'], '"TDM": transmitters that take turns');
    allZero(rf.at('rlBpmChirps'), 'rlBpmChirpCfg_t', ['constBpmVal'], 'no phase coding');
  }
  if (devices.length > 1) return linesOfCascade(file.at('mmWaveDevices'), devices);
  const device = devices[0] as Part;
  const rf = device.at('rfConfig');
  return [
    channels(rf.at('rlChanCfg_t')),
    samples(rf.at('rlAdcOutCfg_t', 'fmt')),
    layout(device.at('rawDataCaptureConfig'), rf.at('rlAdcOutCfg_t', 'fmt', 'b2AdcOutFmt').number() === 0),
    ...rf
      .at('rlProfiles')
      .list('a profile')
      .map((one) => profile(one.at('rlProfileCfg_t'))),
    ...rf
      .at('rlChirps')
      .list('chirps')
      .map((one) => chirps(one.at('rlChirpCfg_t'))),
    frame(rf.at('rlFrameCfg_t')),
  ];
}

/** Chips of a cascade, and the receivers and transmitters of each. */
const CHIPS = 4;
const CHIP_RECEIVERS = 0xf;
const CHIP_TRANSMITTERS = 3;

/** Of a cascade's chips: what they share is the master's, and of each chirp one chip transmits. */
function linesOfCascade(of: Part, devices: readonly Part[]): Line[] {
  if (devices.length !== CHIPS) of.fail('one device, or the four of a cascade', `${devices.length} devices`);
  const rfs = devices.map((device) => device.at('rfConfig'));
  const master = rfs[0] as Part;
  let transmitters = 0;
  rfs.forEach((rf, chip) => {
    const channel = rf.at('rlChanCfg_t');
    channel.at('rxChannelEn').only([CHIP_RECEIVERS], '0xF: all receivers of each chip of a cascade');
    transmitters |= channel.at('txChannelEn').number() << (CHIP_TRANSMITTERS * chip);
  });
  const format = (devices[0] as Part).at('rawDataCaptureConfig', 'rlDevDataFmtCfg_t');
  format.at('iqSwapSel').only([0, 1], '0 (I first) or 1 (Q first)');
  return [
    line('channelCfg', master.at('rlChanCfg_t'), [0xffff, transmitters, 1]),
    samples(master.at('rlAdcOutCfg_t', 'fmt')),
    line('adcbufCfg', format, [-1, 0, format.at('iqSwapSel').number(), 0, 0]),
    ...master
      .at('rlProfiles')
      .list('a profile')
      .map((one) => profile(one.at('rlProfileCfg_t'))),
    ...cascadeChirps(rfs),
    frame(master.at('rlFrameCfg_t')),
  ];
}

function cascadeChirps(rfs: readonly Part[]): Line[] {
  const frame = (rfs[0] as Part).at('rlFrameCfg_t');
  const [first, last] = [frame.at('chirpStartIdx').number(), frame.at('chirpEndIdx').number()];
  if (!(first >= 0 && last >= first && last <= MOST_CHIRPS))
    frame.at('chirpEndIdx').fail(`a chirp from the first to ${MOST_CHIRPS}`);
  const all = rfs.map((rf) =>
    rf
      .at('rlChirps')
      .list('chirps')
      .map((one) => one.at('rlChirpCfg_t')),
  );
  return Array.from({ length: last - first + 1 }, (_, i) => {
    const index = first + i;
    const chips = all.map((chirps, chip) => {
      const one = chirps.find((c) => c.at('chirpStartIdx').number() <= index && index <= c.at('chirpEndIdx').number());
      return one ?? (rfs[chip] as Part).at('rlChirps').fail(`settings of chirp ${index}`, 'without them');
    });
    for (const one of chips) allAlike(one);
    const mask = chips.reduce((sum, one, chip) => sum | (one.at('txEnable').number() << (CHIP_TRANSMITTERS * chip)), 0);
    const [master] = chips as [Part, ...Part[]];
    if (!isOneBit(mask)) master.at('txEnable').fail('one transmitter of all chips a chirp (they take turns)');
    return line('chirpCfg', master, [index, index, master.at('profileId').number(), 0, 0, 0, 0, mask]);
  });
}

const MOST_CHIRPS = 511;

function line(command: string, of: Part, values: readonly (number | string)[]): Line {
  return { text: [command, ...values].join(' '), from: of.path };
}

/** Settings of a list that need not be there, but are zero where they are. */
function allZero(list: Part, name: string, fields: readonly string[], expected: string): void {
  if (!Array.isArray(list.value)) return;
  list.value.forEach((_, i) => {
    for (const field of fields) {
      const one = new Part(list.file, `${list.path}[${i}]`, (list.value as unknown[])[i]).at(name, field);
      if (one.there && one.number() !== 0) one.fail(`0: ${expected}`);
    }
  });
}

function channels(of: Part): Line {
  of.at('cascading').only([0], '0: one chip');
  return line('channelCfg', of, [of.at('rxChannelEn').number(), of.at('txChannelEn').number(), 0]);
}

function samples(of: Part): Line {
  of.at('b2AdcBits').only([0, 1, 2], '0, 1 or 2 (12, 14 or 16 bits)');
  of.at('b2AdcOutFmt').only([0, 1, 2], '0 (real), 1 or 2 (complex samples)');
  return line('adcCfg', of, [of.at('b2AdcBits').number(), of.at('b2AdcOutFmt').number()]);
}

const TWO_LANES = '1: receivers one after another, over two lanes';

function layout(of: Part, real: boolean): Line {
  of.at('rlDevDataPathCfg_t', 'intfSel').only([1], '1: LVDS, as the DCA1000 records');
  of.at('rlDevDataPathCfg_t', 'transferFmtPkt0').only([1], '0x1: samples alone');
  of.at('rlDevDataPathCfg_t', 'transferFmtPkt1').only([0], '0x0: no second packet');
  const lanes = of.at('rlDevLaneEnable_t', 'laneEn');
  lanes.only([3, 15], '0x3: two lanes (xWR16xx, xWR18xx, xWR68xx), or 0xF: four (xWR12xx, xWR14xx, xWR22xx)');
  const format = of.at('rlDevDataFmtCfg_t');
  const interleave = format.at('chInterleave');
  if (lanes.there) {
    const four = lanes.number() === 15;
    interleave.only([four ? 0 : 1], four ? '0: receivers sample by sample, over four lanes' : TWO_LANES);
  } else interleave.only([0, 1], TWO_LANES);
  format.at('iqSwapSel').only([0, 1], '0 (I first) or 1 (Q first)');
  return line('adcbufCfg', format, [-1, Number(real), format.at('iqSwapSel').number(), interleave.number(), 0]);
}

function profile(of: Part): Line {
  const value = (name: string): number => of.at(name).number();
  return line('profileCfg', of, [
    value('profileId'),
    value('startFreqConst_GHz'),
    value('idleTimeConst_usec'),
    value('adcStartTimeConst_usec'),
    value('rampEndTime_usec'),
    ...[0, 0],
    value('freqSlopeConst_MHz_usec'),
    0,
    value('numAdcSamples'),
    value('digOutSampleRate'),
    ...[0, 0, 0],
  ]);
}

function allAlike(of: Part): void {
  for (const name of ['startFreqVar_MHz', 'freqSlopeVar_KHz_usec', 'idleTimeVar_usec', 'adcStartTimeVar_usec'])
    of.at(name).only([0], '0: all chirps alike');
}

const isOneBit = (mask: number): boolean => Number.isInteger(mask) && mask > 0 && (mask & (mask - 1)) === 0;

function chirps(of: Part): Line {
  const value = (name: string): number => of.at(name).number();
  allAlike(of);
  const transmitters = of.at('txEnable');
  const mask = transmitters.number();
  if (!isOneBit(mask)) transmitters.fail('the bit of one transmitter a chirp (they take turns)');
  return line('chirpCfg', of, [value('chirpStartIdx'), value('chirpEndIdx'), value('profileId'), 0, 0, 0, 0, mask]);
}

function frame(of: Part): Line {
  const value = (name: string): number => of.at(name).number();
  return line('frameCfg', of, [
    value('chirpStartIdx'),
    value('chirpEndIdx'),
    value('numLoops'),
    value('numFrames'),
    value('framePeriodicity_msec'),
    ...[1, 0],
  ]);
}
