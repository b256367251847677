/** A widget of Jupyter and its kin: traits of the model are settings, packed data and what came of events. */
import { Mounted } from './mounted.ts';

/** What is used of a model as anywidget hands it over. */
export interface Model {
  get(name: string): unknown;
  set(name: string, value: unknown): void;
  save_changes(): void;
  on(event: string, callback: () => void): void;
  off(event: string, callback: () => void): void;
}

/** What an element's class in Python says of it. Attributes and properties are by their traits, traits by their events. */
interface Description {
  tag: string;
  attributes: Record<string, string>;
  properties: Record<string, string>;
  events: Record<string, string>;
}

export const anywidget = {
  render({ model, el }: { model: Model; el: HTMLElement }): () => void {
    const { tag, attributes, properties, events } = model.get('_description') as Description;
    const mounted = new Mounted(el, tag, Object.keys(events), (event, detail) => {
      model.set(events[event] as string, detail instanceof Uint8Array ? new DataView(detail.buffer) : detail);
      model.save_changes();
    });
    const follow = (trait: string, take: (value: unknown) => void): (() => void) => {
      const changed = (): void => take(model.get(trait));
      model.on(`change:${trait}`, changed);
      changed();
      return () => model.off(`change:${trait}`, changed);
    };
    const followed = [
      ...Object.entries(attributes).map(([trait, name]) => follow(trait, (value) => mounted.attribute(name, value))),
      ...Object.entries(properties).map(([trait, name]) =>
        follow(trait, (value) => mounted.property(name, value as DataView | null)),
      ),
    ];
    return () => {
      for (const end of followed) end();
      mounted.remove();
    };
  },
};
