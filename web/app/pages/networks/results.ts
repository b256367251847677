/** Results of the experiments in research/, fetched when they are looked at; none where the site was built without them. */
import { signal } from '@preact/signals';
import { describeError, FileProblem, type Problem } from '../../data.ts';

export interface Operating {
  precision: number;
  recall: number;
  f1: number;
  strictF1: number;
  angleErrorDeg: number;
  powerErrorDb: number;
}

/** Of `evaluate aoa`: snapshots of many targets. */
export interface AoaReport {
  array: string;
  trials: number;
  /** Further snapshots of each condition, which the one threshold of each method comes from. */
  validation: number;
  seed: number;
  methods: string[];
  conditions: {
    targets: number;
    snrDb: number;
    methods: {
      best: Operating | null;
      /** Nothing of a method without answers in the further snapshots. */
      atOneThreshold: Pick<Operating, 'f1' | 'precision' | 'recall'> | null;
      strictF1: number | null;
      curve?: Operating[];
      separated: { rmseDeg: number | null; boundDeg: number | null; found: number; targets: number };
    }[];
  }[];
}

export interface DoaResult {
  found: number;
  rmseDeg: number | null;
  /** Of angles rounded to whole degrees, which all targets stand at. */
  roundedRmseDeg?: number | null;
  success: number;
  within: [number, number, number];
  closeSuccess: number | null;
  closeWithin: [number | null, number | null, number | null];
}

/** Of `evaluate doa`: regions of interest with up to two targets. */
export interface DoaReport {
  trials: number;
  seed: number;
  methods: string[];
  /** Names of the rules that count; the first four where they are not named. */
  counters?: string[];
  /** By SNR in ascending order: of the frame, and of MUSIC on the region. */
  boundsDeg: [number, number][];
  conditions: {
    targets: 'none' | 'one' | 'apart' | 'together' | 'moving';
    snrDb: number;
    trials: number;
    close: number;
    counted: [number, number, number, number][];
    /** Nothing of networks for another number of targets. */
    methods: (DoaResult | null)[];
  }[];
}

export interface Results {
  aoa?: AoaReport;
  doa?: DoaReport;
}

export const results = signal<Results | null>(null);
export const resultsProblem = signal<Problem | null>(null);

const addresses = import.meta.glob<string>('../../../../research/results/*.json', {
  eager: true,
  query: '?url',
  import: 'default',
});

let loading = false;

export async function loadResults(): Promise<void> {
  if (loading) return;
  loading = true;
  try {
    const found = await Promise.all(
      ['aoa', 'doa'].map(async (name) => {
        const address = addresses[`../../../../research/results/${name}.json`];
        return address ? [name, await report(address)] : null;
      }),
    );
    results.value = Object.fromEntries(found.filter((item) => item !== null)) as Results;
    resultsProblem.value = null;
  } catch (error) {
    loading = false;
    resultsProblem.value = describeError(error);
  }
}

async function report(address: string): Promise<unknown> {
  const response = await fetch(address);
  if (!response.ok)
    throw new FileProblem('not-found', address, `could not be loaded: the server answered ${response.status}`);
  return response.json();
}
