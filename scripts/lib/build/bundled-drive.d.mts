import type { Plugin } from 'vite';

export function readColumns(packed: Uint8Array): string;
export function compact(csv: string): Uint8Array;
export function bundledDrive(): Plugin;
