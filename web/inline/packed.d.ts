// What the build packs (scripts/lib/inline.mjs): the parts one after another, packed together, as text.
export const text: string;
/** Bytes of each part. */
export const parts: Readonly<Record<string, number>>;
