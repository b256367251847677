import { failure, own, wrong } from '../runtime/errors.js';
import { openPort, serialBytes } from './serial.js';
import type { BoardPort, ConfigurationOptions } from './types.js';

const COMMAND_BAUD = 115_200;
const BUFFER = 65_536;
const ANSWER_MS = 5000;
/** How long a prompt may come after the answer; firmware without one is not waited for longer, ms. */
const PROMPT_MS = 200;
/** What a board said before is over when nothing came for so long, ms; and is not waited for longer than this in all. */
const [QUIET_MS, MOST_QUIET_MS] = [50, 1000];
/** More than any line is answered with. */
const MOST_ANSWER = 1 << 16;

/** What a demo of TI's SDK says when it takes the next line, such as `mmwDemo:/>`. */
const PROMPT = /^[ \t]*\w+:\/>/m;
const DONE = /^\s*Done\b/m;
const REFUSED = /^\s*(?:Error|Exception)\b|not recognized/im;

interface Command {
  number: number;
  command: string;
}

/** What of a configuration is sent: lines without comments, and none that are blank. */
export function commandsOf(text: string): Command[] {
  if (typeof text !== 'string') throw wrong('configuration', 'text', text);
  return text
    .replace(/^\ufeff/, '')
    .split(/\r\n|\r|\n/)
    .map((line, at) => ({ number: at + 1, command: (line.split('%')[0] ?? '').trim() }))
    .filter(({ command }) => command !== '');
}

/**
 * Sends a configuration (`.cfg`) to a board's command port, a line after the answer to the one before. Comments and blank
 * lines are passed over. Sending ends with the first line that a board refuses.
 *
 * Throws `command-refused` with the line and what the board said of it, `command-timeout` where no answer comes,
 * `port-lost` where the board is unplugged, and `port-not-opened`.
 */
export async function sendConfiguration(port: BoardPort, text: string, options?: ConfigurationOptions): Promise<void> {
  const {
    baudRate = COMMAND_BAUD,
    timeoutMs = ANSWER_MS,
    signal,
    onLine,
  } = own(options, 'options') as ConfigurationOptions;
  const commands = commandsOf(text);
  signal?.throwIfAborted();
  const opened = await openPort(port, { baudRate, bufferSize: BUFFER });
  const ending = new AbortController();
  const end = (): void => ending.abort();
  signal?.addEventListener('abort', end);
  const heard = new Answers(serialBytes(port, { reconnect: false, signal: ending.signal }));
  const writer = port.writable?.getWriter();
  try {
    await heard.quiet();
    for (const [at, line] of commands.entries()) {
      heard.forget();
      await writer?.write(new TextEncoder().encode(`${line.command}\n`));
      const answer = await heard.answer(line, timeoutMs);
      signal?.throwIfAborted();
      onLine?.({ ...line, answer, sent: at + 1, total: commands.length });
    }
  } catch (error) {
    signal?.throwIfAborted();
    throw error;
  } finally {
    signal?.removeEventListener('abort', end);
    end();
    await heard.ended();
    writer?.releaseLock();
    if (opened) await port.close().catch(() => {});
  }
}

/** What a board says, put to the line it was said of. */
class Answers {
  readonly #bytes: AsyncIterator<Uint8Array>;
  readonly #decoder = new TextDecoder();
  #text = '';
  /** The read under way; it outlives a wait that ends before it. */
  #read: Promise<IteratorResult<Uint8Array>> | null = null;

  constructor(source: AsyncIterable<Uint8Array>) {
    this.#bytes = source[Symbol.asyncIterator]();
  }

  /** Hears out what a board has to say before it is sent anything. */
  async quiet(): Promise<void> {
    const until = performance.now() + MOST_QUIET_MS;
    while (performance.now() < until && (await this.#more(QUIET_MS)));
  }

  /** What was said before a line was sent belongs to none. */
  forget(): void {
    this.#text = '';
  }

  async answer({ number, command }: Command, timeoutMs: number): Promise<string> {
    const what = `line ${number}, ${command}`;
    const until = performance.now() + timeoutMs;
    while (!DONE.test(this.#text) && !REFUSED.test(this.#text)) {
      if (!(await this.#more(until - performance.now()))) {
        const given = this.#said(command) || 'nothing';
        throw failure('command-timeout', { what, expected: `Done within ${timeoutMs} ms`, given });
      }
    }
    const settled = performance.now() + PROMPT_MS;
    while (!PROMPT.test(afterVerdict(this.#text)) && (await this.#more(settled - performance.now())));
    const given = this.#said(command);
    if (REFUSED.test(this.#text)) throw failure('command-refused', { what, expected: 'Done', given });
    return given;
  }

  /** Reads on; false where nothing came in time. */
  async #more(ms: number): Promise<boolean> {
    if (ms <= 0) return false;
    this.#read ??= this.#bytes.next();
    let timer: ReturnType<typeof setTimeout> | undefined;
    const late = new Promise<null>((resolve) => {
      timer = setTimeout(resolve, ms, null);
    });
    try {
      const read = await Promise.race([this.#read, late]);
      if (read === null) return false;
      this.#read = null;
      if (read.done) throw failure('port-lost', { what: 'the command port', expected: 'an answer', given: 'its end' });
      this.#text = (this.#text + this.#decoder.decode(read.value, { stream: true })).slice(-MOST_ANSWER);
      return true;
    } finally {
      clearTimeout(timer);
    }
  }

  /** Lets go of the port once its reading was ended. */
  async ended(): Promise<void> {
    await this.#read?.catch(() => {});
    await this.#bytes.return?.().catch(() => {});
  }

  /** Without prompts, the echo of the command, and blank lines. */
  #said(command: string): string {
    return this.#text
      .split(/[\r\n]+/)
      .map((line) => line.replace(PROMPT, '').trim())
      .filter((line) => line !== '' && line !== command)
      .join('\n');
  }
}

/** A prompt before it is that of the line before. */
function afterVerdict(text: string): string {
  const at = Math.max(text.search(DONE), text.search(REFUSED), 0);
  return text.slice(at);
}
