import type { Plugin } from 'vite';

export function elementsModule(): Plugin;
