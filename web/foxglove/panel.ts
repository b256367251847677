/** What all panels do: settings, topics, messages, theme, and going. */
import type {
  ExtensionContext,
  Immutable,
  MessageEvent,
  PanelExtensionContext,
  Subscription,
  Topic,
} from '@foxglove/extension';
import { MessageProblem } from '../messages/problem.ts';
import { count } from '../plots/format.ts';
import { THEMES, type ThemeName } from '../plots/theme.ts';
import { rangesOf, readRecording } from './recording.ts';
import { opened } from './runtime.ts';
import { edited, kept, type Settings, tree, type ValuesOf } from './settings.ts';

/** A panel while it is there. */
export interface View<S extends Settings> {
  /** What is drawn. */
  element: HTMLElement;
  /** Takes over settings and topics, and says what messages are wanted; once more when the calibration can begin. */
  set(values: ValuesOf<S>, topics: readonly Topic[]): Subscription[];
  /** Whether messages of the whole recording are wanted, where the application has one, and not those that are played. */
  whole?(): boolean;
  take(event: Immutable<MessageEvent>): void;
  /** What came before does not count: the data were wound, or it was asked for. */
  clear(): void;
  /** What there is to say below the plot, and what keeps it from being drawn; called after messages. */
  said(): { status: string; wanted: string | null };
  remove(): void;
}

export interface Panel<S extends Settings> {
  /** In layouts: is never changed. */
  name: string;
  settings: S;
  /** The label of what begins anew. */
  again?: string;
  make(changed: () => void): View<S>;
}

const AGAIN = 'again';
/** Messages that are kept while the calibration is made ready. */
const MOST_HELD = 4096;

export function registerPanel<S extends Settings>(context: ExtensionContext, panel: Panel<S>): void {
  context.registerPanel({ name: panel.name, initPanel: (host) => mount(host, panel) });
}

function mount<S extends Settings>(host: PanelExtensionContext, panel: Panel<S>): () => void {
  let gone = false;
  let values = kept(panel.settings, host.initialState);
  let topics: readonly Topic[] = [];
  let problem = '';
  let subscribed = '';
  let stopReading = (): void => {};
  let read = '';
  /** Messages that come before the calibration can begin; null once it can. */
  let held: Immutable<MessageEvent>[] | null = [];
  let lost = 0;
  const words = document.createElement('p');
  words.setAttribute('role', 'status');
  Object.assign(words.style, { flex: 'none', margin: '0', padding: '4px 12px 6px', fontSize: '12px' });
  const box = document.createElement('div');
  Object.assign(box.style, { display: 'flex', flexDirection: 'column', height: '100%', overflow: 'auto' });

  const say = (): void => {
    if (gone) return;
    const { status, wanted } = view.said();
    const early = lost ? `${count(lost)} messages came before that was ready, and were left out.` : '';
    const text = [
      wanted ?? (held ? 'The calibration is made ready …' : status),
      wanted === null ? read : '',
      early,
      problem,
    ]
      .filter(Boolean)
      .join(' ');
    if (words.textContent !== text) words.textContent = text;
    box.setAttribute('aria-busy', String(held !== null));
    view.element.style.display = wanted === null ? '' : 'none';
  };
  const view = panel.make(say);
  Object.assign(view.element.style, { flex: '1 1 auto', minHeight: '0' });
  view.element.style.setProperty('--boresight-plot-height', '80px');
  box.append(view.element, words);
  host.panelElement.append(box);

  const paint = (theme: ThemeName): void => {
    view.element.setAttribute('theme', theme);
    const { background, muted, font } = THEMES[theme];
    Object.assign(box.style, { background, color: muted, fontFamily: font });
  };
  const recording = {
    begin: () => {
      view.clear();
      read = 'The recording is read, where the data are one …';
    },
    take: (event: Immutable<MessageEvent>) => {
      take(event);
      say();
    },
    end: () => {
      read = 'That is the whole recording.';
      say();
    },
  };
  const settle = (): void => {
    const wanted = view.set(values, topics);
    const ranges = held === null && view.whole?.() ? rangesOf(host) : undefined;
    // To subscribe again would have some sources begin again.
    const now = JSON.stringify([wanted, ranges !== undefined]);
    if (now !== subscribed) {
      stopReading();
      host.subscribe(ranges ? [] : wanted);
      read = '';
      stopReading = ranges && wanted.length ? readRecording(ranges, wanted, recording) : () => {};
    }
    subscribed = now;
    host.updatePanelSettingsEditor({
      nodes: tree(panel.settings, values, topics, panel.again ? [{ id: AGAIN, label: panel.again }] : []),
      actionHandler(action) {
        if (gone) return;
        if (action.action === 'perform-node-action' && action.payload.id === AGAIN) view.clear();
        const next = edited(panel.settings, values, action);
        if (next) {
          values = next;
          problem = '';
          host.saveState(values);
          settle();
        }
        say();
      },
    });
  };
  const take = (event: Immutable<MessageEvent>): void => {
    if (held) {
      if (held.length < MOST_HELD) held.push(event);
      else lost += 1;
      return;
    }
    try {
      view.take(event);
      problem = '';
    } catch (error) {
      if (!(error instanceof MessageProblem)) throw error;
      problem = `A message of ${event.topic} was left out: ${error.message}.`;
    }
  };

  host.onRender = (state, done) => {
    try {
      if (gone) return;
      if (state.colorScheme) paint(state.colorScheme);
      if (state.topics && state.topics !== topics) {
        topics = state.topics as readonly Topic[];
        settle();
      }
      // What is read as a whole does not go by what is played.
      if (state.didSeek && !read) view.clear();
      for (const event of state.currentFrame ?? []) take(event);
      say();
    } finally {
      // Elements draw in a microtask of their own, which comes first.
      queueMicrotask(done);
    }
  };
  for (const field of ['colorScheme', 'topics', 'currentFrame', 'didSeek'] as const) host.watch(field);
  paint(matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light');
  settle();
  say();
  opened().then(
    () => {
      if (gone) return;
      const before = held ?? [];
      held = null;
      settle();
      for (const event of before) take(event);
      say();
    },
    (error: Error) => {
      problem = `The calibration could not be started: ${error.message}`;
      say();
    },
  );
  return () => {
    gone = true;
    stopReading();
    host.unsubscribeAll();
    view.remove();
    box.remove();
  };
}
