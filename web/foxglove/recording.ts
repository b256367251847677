/** A whole recording, where the application hands one over: messages of several topics in order of time. */
import type { Immutable, MessageEvent, PanelExtensionContext, Subscription } from '@foxglove/extension';

type Event = Immutable<MessageEvent>;

export interface Told {
  /** All begins anew. */
  begin(): void;
  take(event: Event): void;
  end(): void;
}

/** Messages taken without a pause. */
const AT_ONCE = 256;

/** A topic's messages, which come in pieces. */
class Lane {
  #pieces: AsyncIterator<Immutable<MessageEvent[]>>;
  #piece: Immutable<MessageEvent[]> = [];
  #at = 0;

  constructor(pieces: AsyncIterable<Immutable<MessageEvent[]>>) {
    this.#pieces = pieces[Symbol.asyncIterator]();
  }

  /** The next message; undefined at the end. */
  async next(): Promise<Event | undefined> {
    while (this.#at >= this.#piece.length) {
      const { done, value } = await this.#pieces.next();
      if (done) return undefined;
      [this.#piece, this.#at] = [value, 0];
    }
    return this.#piece[this.#at];
  }

  pass(): void {
    this.#at += 1;
  }
}

const nanoseconds = ({ receiveTime: { sec, nsec } }: Event): number => sec * 1e9 + nsec;

type Subscribe = NonNullable<PanelExtensionContext['subscribeMessageRange']>;

/** What hands recordings over; Lichtblick calls it unstable, as Foxglove did. */
export function rangesOf(host: PanelExtensionContext): Subscribe | undefined {
  const { unstable_subscribeMessageRange } = host as { unstable_subscribeMessageRange?: Subscribe };
  return host.subscribeMessageRange ?? unstable_subscribeMessageRange ?? host.UNSTABLE_subscribeMessageRange;
}

/** Reads a recording from its start to its end, again where it changes; what it gives ends that. */
export function readRecording(subscribe: Subscribe, wanted: readonly Subscription[], told: Told): () => void {
  let reading = {};
  let lanes = new Map<string, Lane>();
  let stops: (() => void)[] = [];
  const stop = (): void => {
    reading = {};
    for (const one of stops) one();
    stops = [];
    lanes = new Map();
  };
  const start = (): void => {
    stop();
    const mine = reading;
    told.begin();
    let finished = (): void => {};
    const whole = new Promise<void>((resolve) => {
      finished = resolve;
    });
    for (const { topic, convertTo } of wanted) {
      const ended = subscribe({
        topic,
        ...(convertTo === undefined ? {} : { convertTo }),
        onNewRangeIterator: async (pieces) => {
          if (reading !== mine) return;
          // Another beginning of one topic: the others are needed from theirs again.
          if (lanes.has(topic)) {
            start();
            return;
          }
          lanes.set(topic, new Lane(pieces));
          if (lanes.size === wanted.length) await merge(lanes, () => reading === mine, told).finally(finished);
          else await whole;
        },
      });
      stops.push(ended, finished);
    }
  };
  start();
  return stop;
}

async function merge(lanes: ReadonlyMap<string, Lane>, goesOn: () => boolean, told: Told): Promise<void> {
  for (let taken = 1; ; taken++) {
    let first: { lane: Lane; event: Event } | undefined;
    for (const lane of lanes.values()) {
      const event = await lane.next();
      if (event && (!first || nanoseconds(event) < nanoseconds(first.event))) first = { lane, event };
    }
    if (taken % AT_ONCE === 0) await new Promise((resolve) => setTimeout(resolve));
    if (!goesOn()) return;
    if (!first) break;
    first.lane.pass();
    told.take(first.event);
  }
  told.end();
}
