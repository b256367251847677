/** Networks into the pool: fetched when they are first needed, with progress, and kept for the session. */
import { computed, signal } from '@preact/signals';
import type { NetworkInfo } from 'boresight';
import { aborted, describeError, FileProblem, type Problem, pool } from '../data.ts';
import { NETWORKS } from '../kinds.ts';
import type { NamedFile } from '../ui/entries.ts';
import { MODELS, type Model } from './models.ts';
import { hasModule, moduleReady } from './module.ts';

export interface Loading {
  status: 'fetching' | 'waiting' | 'starting' | 'ready' | 'failed' | 'cancelled';
  /** Bytes that are here, and all of them where that is known. */
  done: number;
  total: number;
  info?: NetworkInfo;
  problem?: Problem;
}

export const loadings = signal<ReadonlyMap<string, Loading>>(new Map());

/** A user's own networks, which are in no link. */
export const ownModels = signal<readonly Model[]>([]);
export const models = computed<readonly Model[]>(() => [...MODELS, ...ownModels.value]);

/** Changes when a network becomes ready. */
export const readyNetworks = computed(() =>
  [...loadings.value].flatMap(([name, { status }]) => (status === 'ready' ? [name] : [])).join(),
);

/** Whether a network's loading came to an end before it was ready: it is said, and tried again, where it is listed. */
export function stopped(name: string | undefined): boolean {
  const status = name === undefined ? undefined : loadings.value.get(name)?.status;
  return status === 'failed' || status === 'cancelled';
}

const bytes = new Map<string, Uint8Array>();
/** Texts of the cards that came with a user's own. */
const ownCards = new Map<string, string>();
const pending = new Map<string, { promise: Promise<NetworkInfo>; controller: AbortController }>();

function say(name: string, loading: Loading): void {
  loadings.value = new Map(loadings.peek()).set(name, loading);
}

/**
 * The network of a model, loaded once; what failed or was cancelled is tried again. A signal ends the waiting, not the
 * loading, for others may wait too.
 */
export function load(name: string, signal?: AbortSignal): Promise<NetworkInfo> {
  const loaded = loadOnce(name);
  return signal ? unless(signal, loaded) : loaded;
}

/** Ends the waiting for a promise. */
function unless<T>(signal: AbortSignal, promise: Promise<T>): Promise<T> {
  return new Promise((resolve, reject) => {
    signal.addEventListener('abort', () => reject(signal.reason), { once: true });
    promise.then(resolve, reject);
  });
}

function loadOnce(name: string): Promise<NetworkInfo> {
  const before = pending.get(name);
  if (before) return before.promise;
  const controller = new AbortController();
  const promise = start(name, controller.signal).catch((error: unknown) => {
    pending.delete(name);
    const { done = 0, total = 0 } = loadings.peek().get(name) ?? {};
    say(name, {
      done,
      total,
      ...(aborted(error) ? { status: 'cancelled' } : { status: 'failed', problem: describeError(error) }),
    });
    throw error;
  });
  pending.set(name, { promise, controller });
  return promise;
}

export function cancelLoading(name: string): void {
  pending.get(name)?.controller.abort();
}

async function start(name: string, signal: AbortSignal): Promise<NetworkInfo> {
  const model = models.peek().find((one) => one.name === name);
  if (!model) throw new FileProblem('unknown-network', name, `there is no network “${name}”`);
  let onnx = bytes.get(name);
  if (!onnx) {
    onnx = await fetched(model, signal);
    bytes.set(name, onnx);
  }
  const total = onnx.byteLength;
  if (!hasModule) {
    say(name, { status: 'waiting', done: total, total });
    await unless(signal, moduleReady());
  }
  say(name, { status: 'starting', done: total, total });
  const { card } = model;
  const info = await pool().loadNetwork({ onnx, ...(model.hasCard ? { card } : {}) }, { signal });
  say(name, { status: 'ready', done: total, total, info });
  return info;
}

async function fetched({ name, address, card }: Model, signal: AbortSignal): Promise<Uint8Array> {
  if (!address) throw new FileProblem('not-found', name, 'the file is no longer open; open it again');
  const response = await fetch(address, { signal });
  if (!response.ok || !response.body)
    throw new FileProblem('not-found', name, `could not be loaded: the server answered ${response.status}`);
  const total = card.bytes ?? Number(response.headers.get('Content-Length') ?? 0);
  const parts: Uint8Array[] = [];
  let done = 0;
  say(name, { status: 'fetching', done, total });
  for (const reader = response.body.getReader(); ; ) {
    const { done: last, value } = await reader.read();
    if (last) break;
    parts.push(value);
    done += value.byteLength;
    say(name, { status: 'fetching', done, total });
  }
  const whole = new Uint8Array(done);
  let at = 0;
  for (const part of parts) {
    whole.set(part, at);
    at += part.byteLength;
  }
  return whole;
}

/** Takes a user's own file in; what is wrong with it is thrown, and nothing is kept of it. */
export async function addModel(name: string, onnx: Uint8Array, card: string | undefined): Promise<Model> {
  await moduleReady();
  const info = await pool().loadNetwork({ onnx, ...(card === undefined ? {} : { card }) });
  const { kind: network, inputs, outputs } = info;
  const model: Model = {
    name: `own:${name}`,
    title: info.card?.title ?? name,
    hasCard: card !== undefined,
    card: { name, network, inputs, outputs, bytes: onnx.byteLength, ...info.card },
  };
  const before = loadings.peek().get(model.name)?.info;
  if (before) pool().unloadNetwork(before.id);
  bytes.set(model.name, onnx);
  if (card === undefined) ownCards.delete(model.name);
  else ownCards.set(model.name, card);
  pending.set(model.name, { promise: Promise.resolve(info), controller: new AbortController() });
  say(model.name, { status: 'ready', done: onnx.byteLength, total: onnx.byteLength, info });
  ownModels.value = [...ownModels.peek().filter((one) => one.name !== model.name), model];
  return model;
}

/** A user's own files: networks, and the card of each beside it. */
export function ownFiles(): NamedFile[] {
  return ownModels.peek().flatMap(({ name, card }) => {
    const content = bytes.get(name);
    if (!content) return [];
    const text = ownCards.get(name);
    return [
      { name: card.name, file: new File([content as Uint8Array<ArrayBuffer>], card.name) },
      ...(text === undefined ? [] : [{ name: cardName(card.name), file: new File([text], cardName(card.name)) }]),
    ];
  });
}

const cardName = (onnx: string): string => onnx.replace(/(\.onnx)?$/i, '.json');

/** Takes in what `ownFiles` gave. */
export async function openOwn(files: readonly NamedFile[]): Promise<void> {
  for (const { name, file } of files) {
    if (!NETWORKS.test(name)) continue;
    const card = files.find((other) => other.name === cardName(name));
    await addModel(name, new Uint8Array(await file.arrayBuffer()), await card?.file.text());
  }
}
