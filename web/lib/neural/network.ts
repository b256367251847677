// Neural networks, in a module of their own.
import instantiate, * as glue from '../../wasm/boresight_neural.js';
import { own } from '../runtime/errors.js';
import { Handle } from '../runtime/handle.js';
import { Instance } from '../runtime/module.js';
import type { Report } from '../runtime/report.js';
import type {
  AngleNetworks,
  BatchEstimate,
  BatchInput,
  BatchOptions,
  BytesInput,
  CaptureRegionOptions,
  ChainOptions,
  CombineOptions,
  ComplexData,
  ConfigInput,
  CubeChainOptions,
  CubeRegionOptions,
  Estimate,
  EstimateInput,
  FrameResult,
  ModelCard,
  NetworkDescription,
  NetworkKind,
  NetworkMethod,
  NetworkOptions,
  NetworkPort,
  RegionFrame,
  SourceProbabilities,
  Tensor,
} from '../types.js';

/** The module of this file's functions, loaded by initNeural(). */
export const neural = new Instance(glue, instantiate, { file: 'boresight_neural_bg.wasm', init: 'initNeural()' });

/** Makes networks ready from a compiled module or its bytes, without waiting. */
export function initNeuralSync(module: WebAssembly.Module | BufferSource): void {
  neural.startSync(module);
}

/**
 * Finds regions along range in each frame of a cube and estimates the ranges and azimuths of their targets jointly by
 * maximum likelihood, without networks, for any linear array. Targets have standard deviations.
 */
export function cubeRegions(cube: ComplexData, options: CubeRegionOptions): RegionFrame[] {
  return neural.call(() => glue.jointCubeRegions(cube, options) as RegionFrame[]);
}

/** Like {@link cubeRegions}, for all frames of a capture, or one. */
export function captureRegions(
  bytes: BytesInput,
  config: ConfigInput,
  options?: CaptureRegionOptions,
  frame?: number,
): RegionFrame[] {
  return neural.call(() => glue.jointCaptureRegions(bytes, config, options, frame) as RegionFrame[]);
}

/**
 * A network from an ONNX file, ready to estimate.
 *
 * @example
 * ```js
 * import { readFile } from 'node:fs/promises';
 * import { init, simulateSnapshots } from 'boresight';
 * import { initNeural, Network } from 'boresight/neural';
 *
 * await Promise.all([init(), initNeural()]);
 * const file = (end) => readFile(new URL(import.meta.resolve(`boresight/models/aaetr-any.${end}`)));
 * const network = new Network(await file('onnx'), { card: String(await file('json')), array: 'lrr48' });
 * const targets = [{ azimuthDeg: -5 }, { azimuthDeg: 12, powerDb: -6 }];
 * const { data, shape } = simulateSnapshots({ array: 'lrr48', targets, snrDb: 25, seed: 4 });
 * const { sources } = network.estimate({ snapshots: { data, shape: shape.slice(1) } });
 * network.free();
 * console.log(sources.map(({ azimuthDeg }) => azimuthDeg.toFixed(0))); // → [ '-5', '12' ]
 * ```
 */
export class Network extends Handle<glue.Network> {
  /** What it is. */
  readonly kind: NetworkKind;
  /** The method it estimates by; null for a counting network. */
  readonly method: NetworkMethod | null;
  readonly name: string;
  /** The card it was loaded with; null without. */
  readonly card: ModelCard | null;
  readonly inputs: NetworkPort[];
  readonly outputs: NetworkPort[];

  /**
   * Loads an ONNX file. With a card everything is checked against it, the file's digest too. `array` may be left out:
   * estimates are then for the array the network was made for.
   */
  constructor(onnx: BytesInput, options?: NetworkOptions) {
    const { card, ...estimator } = own(options, 'options') as NetworkOptions;
    const text = typeof card === 'object' && card !== null ? JSON.stringify(card) : card;
    super(neural, () => new glue.Network(onnx, text, estimator));
    const { kind, method, name, inputs, outputs } = this.use((raw) => raw.describe() as NetworkDescription);
    this.kind = kind;
    this.method = method as NetworkMethod | null;
    this.name = name;
    this.inputs = inputs;
    this.outputs = outputs;
    this.card = text == null ? null : (JSON.parse(text) as ModelCard);
  }

  /** Changes the options of its estimates. */
  setOptions(options: Omit<NetworkOptions, 'card'>): void {
    this.use((raw) => raw.setOptions(options));
  }

  estimate(input: EstimateInput): Estimate {
    return this.use((raw) => raw.estimate(input) as Estimate);
  }

  /** Estimates every cell of a batch; each gives what {@link Network.estimate} gives for it alone. */
  estimateBatch(input: BatchInput, options?: BatchOptions): BatchEstimate {
    return this.use((raw) => raw.estimateBatch(input, options) as BatchEstimate);
  }

  /** Counts the sources in snapshots or a covariance of eight elements: counting networks only. */
  count(input: EstimateInput): SourceProbabilities {
    return this.use((raw) => raw.count(input) as SourceProbabilities);
  }

  /** Estimates from the range bins around a peak: [65 bins, 8 elements, 4 chirps]. */
  estimateRegion(region: ComplexData): Estimate {
    return this.use((raw) => raw.estimateRegion(region) as Estimate);
  }

  /** Runs the graph as it is: named inputs to named outputs. */
  run(inputs: Readonly<Record<string, Tensor>>): Record<string, Tensor> {
    return this.use((raw) => raw.run(inputs) as Record<string, Tensor>);
  }

  /** As `processCube` of the package, angles by this network. */
  processCube(cube: ComplexData, options: CubeChainOptions): FrameResult[] {
    return this.use((raw) => raw.processCube(cube, options) as FrameResult[]);
  }

  /** Detections of frames of a capture, each by itself, angles by this network; all frames, or one. */
  processFrames(bytes: BytesInput, config: ConfigInput, options?: ChainOptions, frame?: number): FrameResult[] {
    return this.use((raw) => raw.processFrames(bytes, config, options, frame) as FrameResult[]);
  }

  /**
   * Regions of each frame of a cube, found along range, their targets counted by this network and told apart by `one` or
   * `two`: counting networks only (Figure 4 of Sang et al. 2021).
   */
  cubeRegions({ one, two }: AngleNetworks<Network>, cube: ComplexData, options: CubeRegionOptions): RegionFrame[] {
    return this.#with(one, two, (...raw) => glue.cubeRegions(...raw, cube, options) as RegionFrame[]);
  }

  /** The same of frames of a capture; all frames, or one. */
  captureRegions(
    { one, two }: AngleNetworks<Network>,
    bytes: BytesInput,
    config: ConfigInput,
    options?: CaptureRegionOptions,
    frame?: number,
  ): RegionFrame[] {
    return this.#with(
      one,
      two,
      (...raw) => glue.captureRegions(...raw, bytes, config, options, frame) as RegionFrame[],
    );
  }

  /** As `combineFrames` of a capture, angles by this network. */
  combineFrames(bytes: BytesInput, config: ConfigInput, options?: CombineOptions, report?: Report): FrameResult {
    return this.use((raw) => raw.combineFrames(bytes, config, options, report) as FrameResult);
  }

  /** Runs what takes three networks. */
  #with<T>(one: Network, two: Network, work: (...raw: [glue.Network, glue.Network, glue.Network]) => T): T {
    return this.use((counting) => one.use((first) => two.use((second) => work(counting, first, second))));
  }
}
