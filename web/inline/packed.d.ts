// What the build packs (scripts/lib/build/inline.mjs): each part by gzip, in base64.
export const parts: Readonly<Record<string, string>>;
