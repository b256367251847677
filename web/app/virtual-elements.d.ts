declare module 'virtual:elements' {
  interface Told {
    readonly name: string;
    readonly type: string;
    readonly description: string;
  }
  /** The custom elements by their manifest (scripts/lib/build/manifest.mjs). */
  export const elements: readonly {
    readonly tag: string;
    readonly name: string;
    readonly description: string;
    readonly attributes: readonly Told[];
    readonly properties: readonly Told[];
    readonly events: readonly { readonly name: string; readonly description: string }[];
  }[];
}
