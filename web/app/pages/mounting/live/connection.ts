/** A connection to a server of the Foxglove WebSocket protocol, which comes back by itself. */
import { FoxgloveClient } from '@foxglove/ws-protocol';

/** A channel that a server offers; what else it says of one is not kept. */
export interface Channel {
  id: number;
  topic: string;
  encoding: string;
  schemaName: string;
}

export type ConnectionState =
  | { kind: 'idle' }
  | { kind: 'connecting' }
  | { kind: 'connected'; server: string }
  /** Until it is tried anew. */
  | { kind: 'waiting'; untilMs: number; why: string };

/** What is told. */
export interface Told {
  state(state: ConnectionState): void;
  channels(channels: readonly Channel[]): void;
  message(channel: Channel, data: ArrayBufferView, timeS: number): void;
  /** Something that is no message of the protocol came. */
  malformed(why: string): void;
}

/** Messages above are not looked at. */
const LARGEST_BYTES = 16 * 2 ** 20;
const MOST_CHANNELS = 1000;
const LONGEST_NAME = 200;
/** A server that takes a connection and says nothing. */
const PATIENCE_MS = 10_000;
const WAITS_MS = [1000, 2000, 4000, 8000, 10_000];
const PROTOCOLS = [FoxgloveClient.SUPPORTED_SUBPROTOCOL, 'foxglove.sdk.v1'];

export class Connection {
  readonly #address: string;
  readonly #told: Told;
  #socket: WebSocket | null = null;
  #client: FoxgloveClient | null = null;
  #channels = new Map<number, Channel>();
  /** What is subscribed to, by the number of the subscription. */
  #subscriptions = new Map<number, Channel>();
  #wanted: (channel: Channel) => boolean = () => false;
  #tries = 0;
  #timer: ReturnType<typeof setTimeout> | undefined;

  constructor(address: string, told: Told) {
    this.#address = address;
    this.#told = told;
  }

  open(): void {
    clearTimeout(this.#timer);
    this.#told.state({ kind: 'connecting' });
    const socket = new WebSocket(this.#address, PROTOCOLS);
    this.#socket = socket;
    const guarded = this.#guard(socket);
    const client = new FoxgloveClient({ ws: guarded });
    this.#client = client;
    client.on('serverInfo', ({ name }) => {
      clearTimeout(this.#timer);
      this.#tries = 0;
      this.#told.state({ kind: 'connected', server: named(name) });
    });
    client.on('advertise', (channels) => this.#advertised(channels));
    client.on('unadvertise', (ids) => this.#unadvertised(ids));
    client.on('message', ({ subscriptionId, timestamp, data }) => {
      const channel = this.#subscriptions.get(subscriptionId);
      if (channel) this.#told.message(channel, data, Number(timestamp) / 1e9);
      else this.#told.malformed('a message of no channel that was asked for');
    });
    client.on('error', ({ message }) => {
      if (socket.readyState !== WebSocket.OPEN) return;
      // The successor has kinds of messages that the client does not know, of playback; none is needed.
      const more =
        socket.protocol !== FoxgloveClient.SUPPORTED_SUBPROTOCOL && /^Unrecognized server opcode/.test(message);
      if (!more) this.#told.malformed(message);
    });
    client.on('close', ({ reason }) => {
      if (this.#socket === socket) this.#lost(reason);
    });
    this.#timer = setTimeout(() => this.#lost('it does not answer'), PATIENCE_MS);
  }

  /** Ends it for good. */
  close(): void {
    clearTimeout(this.#timer);
    this.#drop();
    this.#told.state({ kind: 'idle' });
  }

  /** Subscribes to the channels that are wanted, and to no others. */
  want(wanted: (channel: Channel) => boolean): void {
    this.#wanted = wanted;
    this.#subscribe();
  }

  /** The socket as the client sees it: of what a server sends nothing is thrown at the page. */
  #guard(socket: WebSocket) {
    type Handler = ((event: unknown) => void) | null;
    const guarded = {
      binaryType: 'arraybuffer',
      protocol: '',
      onerror: null as Handler,
      onopen: null as Handler,
      onclose: null as Handler,
      onmessage: null as Handler,
      close: () => socket.close(),
      send: (data: string | ArrayBuffer | ArrayBufferView) => socket.send(data as string),
    };
    socket.binaryType = 'arraybuffer';
    socket.onopen = (event) => guarded.onopen?.(event);
    socket.onclose = (event) => guarded.onclose?.(event);
    socket.onerror = (event) => guarded.onerror?.(event);
    socket.onmessage = (event: MessageEvent<string | ArrayBuffer>) => {
      const bytes = typeof event.data === 'string' ? event.data.length : event.data.byteLength;
      if (bytes > LARGEST_BYTES) {
        this.#told.malformed(
          `a message of ${Math.round(bytes / 2 ** 20)} MiB; at most ${LARGEST_BYTES / 2 ** 20} are expected`,
        );
        return;
      }
      try {
        guarded.onmessage?.(event);
      } catch (error) {
        this.#told.malformed(error instanceof Error ? error.message : String(error));
      }
    };
    return guarded;
  }

  #drop(): void {
    const socket = this.#socket;
    [this.#socket, this.#client] = [null, null];
    this.#channels.clear();
    this.#subscriptions.clear();
    this.#told.channels([]);
    if (!socket) return;
    socket.onmessage = null;
    socket.close();
  }

  #lost(why: string): void {
    clearTimeout(this.#timer);
    this.#drop();
    const wait = WAITS_MS[Math.min(this.#tries, WAITS_MS.length - 1)] as number;
    this.#tries += 1;
    this.#told.state({ kind: 'waiting', untilMs: Date.now() + wait, why: named(why) });
    this.#timer = setTimeout(() => this.open(), wait);
  }

  #advertised(given: unknown): void {
    for (const one of Array.isArray(given) ? given : []) {
      const channel = channelOf(one);
      if (!channel) this.#told.malformed('a channel without a number and names');
      else if (this.#channels.size >= MOST_CHANNELS && !this.#channels.has(channel.id))
        this.#told.malformed(`more than ${MOST_CHANNELS} channels`);
      else this.#channels.set(channel.id, channel);
    }
    this.#changed();
  }

  #unadvertised(given: unknown): void {
    for (const id of Array.isArray(given) ? given : []) {
      this.#channels.delete(id as number);
      for (const [subscription, channel] of this.#subscriptions)
        if (channel.id === id) this.#subscriptions.delete(subscription);
    }
    this.#changed();
  }

  #changed(): void {
    this.#told.channels([...this.#channels.values()]);
    this.#subscribe();
  }

  #subscribe(): void {
    const client = this.#client;
    if (!client || this.#socket?.readyState !== WebSocket.OPEN) return;
    const has = new Set<number>();
    for (const [subscription, channel] of this.#subscriptions) {
      if (this.#channels.get(channel.id) === channel && this.#wanted(channel)) has.add(channel.id);
      else {
        client.unsubscribe(subscription);
        this.#subscriptions.delete(subscription);
      }
    }
    for (const channel of this.#channels.values())
      if (!has.has(channel.id) && this.#wanted(channel)) this.#subscriptions.set(client.subscribe(channel.id), channel);
  }
}

const named = (given: unknown): string => (typeof given === 'string' ? given.slice(0, LONGEST_NAME) : '');

function channelOf(given: unknown): Channel | null {
  const { id, topic, encoding, schemaName } = (given ?? {}) as Record<string, unknown>;
  const names = [topic, encoding, schemaName];
  if (!Number.isInteger(id) || !names.every((name) => typeof name === 'string' && name.length <= LONGEST_NAME))
    return null;
  return { id: id as number, topic: topic as string, encoding: encoding as string, schemaName: schemaName as string };
}
