/** Serial ports of this browser, where it has any. */
import { batch, signal } from '@preact/signals';
import { type BoardPort, type SentLine, sendConfiguration } from 'boresight';
import { aborted, describeError, type Problem } from '../../data.ts';
import { announce } from '../../state/announce.ts';
import { profile } from './profile.ts';
import { liveState } from './state.ts';

/** What of Web Serial a page needs beside ports. */
interface Serial {
  requestPort(): Promise<BoardPort & { getInfo?(): { usbVendorId?: number; usbProductId?: number } }>;
}

export const serial = (): Serial | undefined => (navigator as { serial?: Serial }).serial;

export interface ChosenPort {
  port: BoardPort;
  name: string;
}

export type Role = 'command' | 'data';
export const ports = signal<Partial<Record<Role, ChosenPort>>>({});
export const portProblem = signal<Problem | null>(null);

/** Lines that were sent, and how many there are. */
export const sending = signal<{ lines: readonly SentLine[]; total: number; done: boolean } | null>(null);

const hex = (id: number): string => id.toString(16).padStart(4, '0');

/** Asks for a port; the same cannot be both. */
export async function choosePort(role: Role): Promise<ChosenPort | null> {
  try {
    const port = await serial()?.requestPort();
    if (!port) return null;
    const other = role === 'command' ? 'data' : 'command';
    if (ports.peek()[other]?.port === port) {
      portProblem.value = {
        code: 'same-port',
        message: `This is the ${other} port. A board has two; the other one is expected.`,
      };
      return null;
    }
    const { usbVendorId: vendor, usbProductId: product } = port.getInfo?.() ?? {};
    const name = vendor === undefined ? 'Serial port' : `USB ${hex(vendor)}:${hex(product ?? 0)}`;
    const chosen = { port, name };
    batch(() => {
      portProblem.value = null;
      ports.value = { ...ports.peek(), [role]: chosen };
    });
    announce(`${role === 'command' ? 'Command' : 'Data'} port: ${name}.`);
    return chosen;
  } catch (error) {
    // None was chosen.
    if (!(error instanceof DOMException && error.name === 'NotFoundError')) portProblem.value = describeError(error);
    return null;
  }
}

let running: AbortController | undefined;

export function cancelSending(): void {
  running?.abort();
}

/** Sends the configuration; how far it came stays shown. */
export async function sendProfile(): Promise<void> {
  const [text, command] = [profile.peek()?.text, ports.peek().command];
  if (!text || !command || running) return;
  const controller = new AbortController();
  running = controller;
  batch(() => {
    portProblem.value = null;
    sending.value = { lines: [], total: 0, done: false };
  });
  try {
    await sendConfiguration(command.port, text, {
      baudRate: liveState.peek().commandBaud,
      signal: controller.signal,
      onLine: (line) => {
        const lines = [...(sending.peek()?.lines ?? []), line];
        sending.value = { lines, total: line.total, done: false };
      },
    });
    announce('The board has taken the configuration.');
  } catch (error) {
    if (!aborted(error)) portProblem.value = describeError(error);
  } finally {
    running = undefined;
    const before = sending.peek();
    sending.value = before && { ...before, done: true };
  }
}
