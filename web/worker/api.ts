// The functions of the package as promises.
import type * as lib from '../lib/types.js';
import { Crew, type JobOptions, type Piece, type Runtime } from './pool.js';
import type { OperationName, Operations } from './protocol.js';
import { split } from './split.js';

/** Options of {@link createPool}. */
export interface PoolOptions {
  /** Number of workers; by default one a processor core, at most 8. */
  workers?: number;
}

/** A pool of workers with the functions of the package. Workers start when there is work. */
export class Pool {
  readonly #crew: Crew;

  /** @internal */
  constructor(runtime: Runtime, { workers }: PoolOptions = {}) {
    this.#crew = new Crew(runtime, workers);
  }

  /** Most workers that run at a time. */
  get workers(): number {
    return this.#crew.size;
  }

  version(job?: JobOptions): Promise<string> {
    return this.#one('version', [], job);
  }

  methods(job?: JobOptions): Promise<lib.MethodInfo[]> {
    return this.#one('methods', [], job);
  }

  arrayPresets(job?: JobOptions): Promise<string[]> {
    return this.#one('arrayPresets', [], job);
  }

  array(input: lib.ArrayInput, job?: JobOptions): Promise<lib.ArrayGeometry> {
    return this.#one('array', [input], job);
  }

  estimate(input: lib.EstimateInput, options: lib.EstimatorOptions, job?: JobOptions): Promise<lib.Estimate> {
    return this.#one('estimate', [input, options], job);
  }

  /** Estimates of many inputs, split over the workers; progress counts inputs. */
  async estimateMany(
    inputs: readonly lib.EstimateInput[],
    options: lib.EstimatorOptions,
    job?: JobOptions,
  ): Promise<lib.Estimate[]> {
    const pieces = split(inputs.length, this.workers).map(({ first, count }): Piece<'estimateMany'> => ({
      name: 'estimateMany',
      args: [inputs.slice(first, first + count), options],
      units: count,
    }));
    return (await this.#crew.run(pieces, job)).flat();
  }

  /** Ends the workers; jobs under way reject with the code `terminated`. */
  terminate(): void {
    this.#crew.terminate();
  }

  async #one<N extends OperationName>(
    name: N,
    args: Parameters<Operations[N]>,
    job?: JobOptions,
  ): Promise<ReturnType<Operations[N]>> {
    const [result] = await this.#crew.run([{ name, args, units: 1 }], job);
    return result as ReturnType<Operations[N]>;
  }
}
