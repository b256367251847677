/** Binds a page's state to the address. */
import { signal, useSignalEffect } from '@preact/signals';
import { useEffect, useRef, useState } from 'preact/hooks';
import { unreadable } from './comparison.ts';
import { note, step } from './history.ts';
import {
  lastParams,
  type Page,
  pageAddress,
  type Route,
  route,
  setParams,
  writeParams,
  writePending,
} from './route.ts';

/** What of the address was not understood, as it stands there. */
export const misread = signal<readonly string[]>([]);

/** A codec, whatever it holds. */
interface AnyCodec {
  read(params: URLSearchParams): unknown;
  write(state: never): URLSearchParams;
  unreadable(params: URLSearchParams): string[];
}

/** What is shown, said where it is seen without its page. */
export interface Caption {
  /** Files, or what was simulated. */
  data: string;
  /** The settings that matter most. */
  settings: string;
}

let present: {
  page: Page;
  codec: AnyCodec;
  restore(params: URLSearchParams): void;
  write(): URLSearchParams;
  caption(): Caption;
} | null = null;

// Effects run after the next frame. A link followed before that must still leave the last change in
// the history.
addEventListener(
  'click',
  ({ target }) => {
    if (!(target instanceof Element && target.closest('a[href]'))) return;
    if (present?.page === route.peek().page) writeParams(present.page, present.write());
    writePending();
  },
  { capture: true },
);

export function caption(): Caption | null {
  return present?.caption() ?? null;
}

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

/** Puts parameters in place of a page's own, and shows the page if it is to be shown. */
export function goTo(page: Page, params: URLSearchParams, show: boolean): void {
  setParams(page, params);
  if (present?.page === page && route.peek().page === page) present.restore(params);
  else if (show) location.hash = pageAddress(page, params);
}

export interface Binding {
  codec: AnyCodec;
  /** Takes the state from parameters: those of the address, or where it has none those the page was left with. */
  restore(params: URLSearchParams): void;
  /** What runs while the page is there; returns what ends it. */
  start(): () => void;
  /** The state as parameters; runs again when signals it reads change. */
  write(): URLSearchParams;
  caption(): Caption;
}

/** Restores a page's state before its first drawing and when the address changes, and writes it back. */
export function useAddress(page: Page, { codec, restore, start, write, caption }: Binding): void {
  const ready = useRef(false);
  const read = (now: Route): void => {
    if (now.page !== page) return;
    present = { page, codec, restore, write, caption };
    misread.value = unreadable(codec, now.params);
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
