/** Neural networks: what `boresight/neural` and the pool take and give. */
import type {
  ArrayCalibrationInput,
  ArrayInput,
  EstimatorOptions,
  NetworkDescription,
  NetworkKind,
  NetworkPort,
  RegionChainOptions,
  Waveform,
} from '../types.js';

/** Networks that estimate angles, as methods of an estimator; they need a model. */
export type NetworkMethod = Exclude<NetworkKind, 'counting'>;

/** An input or output as a card has it. */
export interface CardPort extends NetworkPort {
  /** What it holds, in words. */
  meaning?: string;
}

/** The card beside a model: what it is, how it was trained, how well it does. */
export interface ModelCard {
  network: NetworkKind;
  /** Size, such as `small`. */
  form?: string;
  name: string;
  title?: string;
  /** The publication. */
  reference?: string;
  inputs: CardPort[];
  outputs: CardPort[];
  /** Number of trained numbers. */
  parameters?: number;
  /** Confidence from which a source counts unless `confidence` says otherwise. */
  confidence?: number;
  /** Digest of the ONNX file, hexadecimal; a file of another digest is refused. */
  sha256?: string;
  /** Scores by condition; a network for any array names the array of each. */
  metrics?: Record<string, number | string>[];
  /** All else the card tells: data, training, hardware. */
  [name: string]: unknown;
}

/** Numbers in C order with their shape. */
export interface Tensor {
  data: Float32Array;
  shape: readonly number[];
}

/**
 * Options of a `Network`: its card, and those of its estimates. `method` is for a counting network, which with
 * `sources: 'network'` counts for any method that needs no network.
 */
export interface NetworkOptions extends Partial<Omit<EstimatorOptions, 'network'>> {
  /** The card, or its JSON. Without one what the network is follows from its inputs and outputs. */
  card?: string | ModelCard;
}

/** Networks for the targets of a region: they tell the angles of one and of two, and are of one kind. */
export interface AngleNetworks<N> {
  one: N;
  two: N;
}

/** Networks for regions on a pool, by their ids. */
export interface RegionNetworkIds extends AngleNetworks<string> {
  /** The counting network. */
  counting: string;
}

/** Options of regions in captures. */
export interface CaptureRegionOptions extends RegionChainOptions {
  /** By default that of the capture's platform. */
  array?: ArrayInput;
  /** What is known of the array's errors. Default what the board's configuration says. */
  calibration?: ArrayCalibrationInput;
}

/** Options of regions in cubes, of which nothing else is known. */
export interface CubeRegionOptions extends RegionChainOptions {
  waveform: Waveform;
  array: ArrayInput;
  /** What is known of the array's errors. */
  calibration?: ArrayCalibrationInput;
}

/** A network as a pool is given it. */
export interface NetworkFile {
  onnx: Uint8Array | ArrayBuffer;
  card?: string | ModelCard;
}

/** A network a pool has loaded. */
export interface NetworkInfo extends NetworkDescription {
  /** What `network` in options of the pool's functions names it by. */
  id: string;
  /** The method it is estimated with; null for a counting network. */
  method: NetworkMethod | null;
  /** Null where none was given. */
  card: ModelCard | null;
  /** Time from its bytes to being ready, in the worker that loaded it first. */
  readyMs: number;
}
