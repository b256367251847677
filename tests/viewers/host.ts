/**
 * A host of extensions as Foxglove and Lichtblick are, made by the types of @foxglove/extension alone: it runs the script by
 * `new Function`, opens panels, hands messages out as they are subscribed to, and keeps what panels tell.
 */
import type {
  ExtensionContext,
  ExtensionPanelRegistration,
  Immutable,
  LegacyRegisterMessageConverterArgs,
  MessageEvent,
  PanelExtensionContext,
  RenderState,
  SettingsTree,
  SettingsTreeAction,
  Subscription,
  Topic,
  TopicAliasFunction,
  VariableValue,
} from '@foxglove/extension';

type Converter = LegacyRegisterMessageConverterArgs;
type Variables = Record<string, VariableValue>;

export class Host {
  readonly panels = new Map<string, ExtensionPanelRegistration>();
  readonly converters: Converter[] = [];
  readonly topics: Topic[] = [];
  /** The messages of a recording, in order; null where the data are live. */
  recording: readonly MessageEvent[] | null = null;
  /** Whether variables come with each message, as in Lichtblick, or by aliases alone. */
  handsOver = false;
  #aliases: TopicAliasFunction[] = [];
  #variables: Variables = {};

  /** Runs the script of an extension as both applications do: `exports` is not handed over. */
  load(source: string): void {
    const module: { exports: { activate?: (context: ExtensionContext) => void } } = { exports: {} };
    const required = (name: string): unknown => ({})[name];
    new Function('module', 'require', source)(module, required, {});
    const panels = this.panels;
    const register = (args: { type?: string } & object): void => {
      if (args.type === 'topic') throw new Error('this host has no conversions of topics');
      this.converters.push(args as Converter);
    };
    module.exports.activate?.({
      mode: 'production',
      registerPanel(registration) {
        if (panels.has(registration.name)) throw new Error(`two panels ${registration.name}`);
        panels.set(registration.name, registration);
      },
      registerMessageConverter: register,
      registerTopicAliases: (aliases) => this.#aliases.push(aliases),
    });
  }

  setVariables(variables: Variables): void {
    this.#variables = variables;
    for (const aliases of this.#aliases) aliases({ topics: this.topics, globalVariables: variables });
  }

  convert(toSchemaName: string, event: Immutable<MessageEvent>): unknown {
    const found = this.converters.find(
      (one) => one.fromSchemaName === event.schemaName && one.toSchemaName === toSchemaName,
    );
    if (!found) throw new Error(`no conversion of ${event.schemaName} to ${toSchemaName}`);
    const more = this.handsOver ? [this.#variables] : [];
    return (found.converter as (...args: unknown[]) => unknown)(event.message, event, ...more);
  }

  open(name: string, initialState: unknown = undefined): Opened {
    const registration = this.panels.get(name);
    if (!registration) throw new Error(`no panel ${name}`);
    return new Opened(this, registration, initialState);
  }
}

/** An open panel. */
export class Opened {
  readonly element: HTMLDivElement;
  settings: Immutable<SettingsTree> | null = null;
  subscriptions: Subscription[] = [];
  subscribed = 0;
  /** What the layout keeps. */
  state: unknown;
  rendered = 0;
  #host: Host;
  #context: PanelExtensionContext;
  #watched = new Set<keyof RenderState>();
  #busy = false;
  #unmount: () => void;
  /** Topics that are read as a whole, and what has them begin anew. */
  readonly ranges = new Map<string, () => void>();
  #gone = false;

  constructor(host: Host, registration: ExtensionPanelRegistration, initialState: unknown) {
    this.#host = host;
    this.state = initialState;
    this.element = document.createElement('div');
    this.element.className = 'panel';
    document.body.append(this.element);
    const alive = (): void => {
      if (this.#gone) throw new Error('a panel that is gone asks for something');
    };
    this.#context = {
      panelElement: this.element,
      initialState,
      layout: { addPanel() {} },
      watch: (field: keyof RenderState) => void this.#watched.add(field),
      saveState: (state) => {
        alive();
        // It is kept as JSON.
        this.state = JSON.parse(JSON.stringify(state));
      },
      setParameter() {},
      setSharedPanelState() {},
      setVariable() {},
      setPreviewTime() {},
      subscribe: (wanted: Subscription[] | string[]) => {
        alive();
        this.subscribed += 1;
        this.subscriptions = wanted.map((one) => (typeof one === 'string' ? { topic: one } : one));
      },
      unsubscribeAll: () => {
        this.subscriptions = [];
      },
      subscribeAppSettings() {},
      updatePanelSettingsEditor: (settings) => {
        alive();
        this.settings = settings;
      },
      setDefaultPanelTitle() {},
    };
    const { recording } = host;
    if (recording) this.#hand(recording);
    this.#unmount = registration.initPanel(this.#context) ?? (() => {});
  }

  /** Hands a recording out, topic by topic. */
  #hand(recording: readonly MessageEvent[]): void {
    this.#context.subscribeMessageRange = ({ topic, convertTo, onNewRangeIterator }) => {
      const all = recording.filter((event) => event.topic === topic);
      let cancelled = false;
      const begin = (): void =>
        void onNewRangeIterator(
          (async function* () {
            for (let at = 0; at < all.length && !cancelled; at += 200) {
              await new Promise((resolve) => setTimeout(resolve));
              yield all.slice(at, at + 200);
            }
          })(),
        );
      if (convertTo) throw new Error('this host converts no recordings');
      queueMicrotask(begin);
      this.ranges.set(topic, begin);
      return () => {
        cancelled = true;
        this.ranges.delete(topic);
      };
    };
  }

  /** A render, which ends with `done`; fields that are not watched do not come. */
  render(state: RenderState): Promise<void> {
    const { onRender } = this.#context;
    if (!onRender) throw new Error('the panel has no onRender');
    if (this.#busy) throw new Error('the panel is asked to render before it is done');
    const given = Object.fromEntries(
      Object.entries(state).filter(([field]) => this.#watched.has(field as keyof RenderState)),
    );
    this.#busy = true;
    return new Promise((resolve) => {
      onRender(given, () => {
        if (!this.#busy) throw new Error('done twice');
        this.#busy = false;
        this.rendered += 1;
        resolve();
      });
    });
  }

  /** Renders with those of some messages that are subscribed to, converted where that is asked for. */
  play(events: readonly MessageEvent[], more: RenderState = {}): Promise<void> {
    const currentFrame = events.flatMap((event) =>
      this.subscriptions
        .filter(({ topic }) => topic === event.topic)
        .map(({ convertTo }): MessageEvent => {
          if (!convertTo) return event;
          const message = this.#host.convert(convertTo, event);
          return { ...event, schemaName: convertTo, message, originalMessageEvent: event };
        }),
    );
    return this.render({ currentFrame, ...more });
  }

  act(action: SettingsTreeAction): void {
    this.settings?.actionHandler(action);
  }

  /** Edits a setting by its label, as the editor of the application does. */
  edit(label: string, value: unknown): void {
    for (const [node, { fields } = {}] of Object.entries(this.settings?.nodes ?? {})) {
      for (const [key, field] of Object.entries(fields ?? {})) {
        if (field?.label !== label) continue;
        const payload = { path: [node, key], input: field.input, value };
        this.act({ action: 'update', payload } as SettingsTreeAction);
        return;
      }
    }
    throw new Error(`no setting ${label}`);
  }

  /** Takes the panel away; gives what it has left in its element. */
  close(): number {
    this.#unmount();
    this.#gone = true;
    const left = this.element.childElementCount + this.subscriptions.length;
    this.element.remove();
    return left;
  }
}

declare global {
  var host: Host;
}
globalThis.host = new Host();
