/** A component of Streamlit, second version: called anew with each run of the script. */
import { unpack } from './codec.ts';
import { Mounted } from './mounted.ts';

/** What is used of a component as Streamlit hands it over. */
export interface Component {
  data: Uint8Array;
  parentElement: HTMLElement | ShadowRoot;
  setStateValue(name: string, value: unknown): void;
}

interface Given {
  tag: string;
  attributes: Record<string, string | number | boolean | null>;
  properties: Record<string, Uint8Array>;
  events: Record<string, string>;
}

const mounts = new WeakMap<Node, Mounted>();

/** Shows the element or brings it up to date; what it gives ends it. */
export function streamlit({ data, parentElement, setStateValue }: Component): () => void {
  const { tag, attributes, properties, events } = unpack(data) as Given;
  const mounted =
    mounts.get(parentElement) ??
    new Mounted(parentElement, tag, Object.keys(events), (event, detail) => {
      setStateValue(events[event] as string, detail instanceof Uint8Array ? base64(detail) : detail);
    });
  mounts.set(parentElement, mounted);
  for (const [name, value] of Object.entries(attributes)) mounted.attribute(name, value);
  for (const [name, packed] of Object.entries(properties)) mounted.property(name, packed);
  return () => {
    mounts.delete(parentElement);
    mounted.remove();
  };
}

/** States are JSON. */
function base64(bytes: Uint8Array): string {
  let text = '';
  for (let at = 0; at < bytes.length; at += 0x8000) text += String.fromCharCode(...bytes.subarray(at, at + 0x8000));
  return btoa(text);
}
