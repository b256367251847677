import type { Plugin } from 'vite';

export function compressFolder(folder: string, keep?: string): Promise<void>;
export function compressed(): Plugin;
