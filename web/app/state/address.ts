/** Binds a page's state to the address. */
import { signal, useSignalEffect } from '@preact/signals';
import { useEffect, useRef, useState } from 'preact/hooks';
import { note, step } from './history.ts';
import { lastParams, type Page, type Route, route, writeParams } from './route.ts';

/** What of the address was not understood, as it stands there. */
export const misread = signal<readonly string[]>([]);

/** A codec, whatever it holds. */
interface AnyCodec {
  read(params: URLSearchParams): unknown;
  write(state: never): URLSearchParams;
  unreadable(params: URLSearchParams): string[];
}

let present: { page: Page; codec: AnyCodec; restore(params: URLSearchParams): void } | null = null;

/** Parameters as the page that is shown would write them. */
export function canonical(page: Page, params: URLSearchParams): URLSearchParams {
  if (present?.page !== page) return params;
  const { codec } = present;
  return codec.write(codec.read(params) as never);
}

/** Takes back the last change of the page's settings (-1), or makes it again (1). */
export function undo(by: -1 | 1): void {
  const params = step(by);
  if (params) present?.restore(params);
}

export interface Binding {
  codec: AnyCodec;
  /** Takes the state from parameters: those of the address, or where it has none those the page was left with. */
  restore(params: URLSearchParams): void;
  /** What runs while the page is there; returns what ends it. */
  start(): () => void;
  /** The state as parameters; runs again when signals it reads change. */
  write(): URLSearchParams;
}

/** Restores a page's state before its first drawing and when the address changes, and writes it back. */
export function useAddress(page: Page, { codec, restore, start, write }: Binding): void {
  const ready = useRef(false);
  const read = (now: Route): void => {
    if (now.page !== page) return;
    present = { page, codec, restore };
    misread.value = codec.unreadable(now.params);
    restore(now.params.size ? now.params : (lastParams(page) ?? now.params));
  };
  useState(() => read(route.peek()));
  useEffect(() => {
    ready.current = true;
    return start();
  }, []);
  useSignalEffect(() => {
    const now = route.value;
    if (ready.current) read(now);
  });
  useSignalEffect(() => {
    const params = write();
    writeParams(page, params);
    note(page, params);
  });
}
