import type { Plugin } from 'vite';

export function readColumns(packed: Uint8Array): Uint8Array;
export function bundledDrive(): Plugin;
