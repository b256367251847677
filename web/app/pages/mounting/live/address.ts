/** Addresses of servers: those of this machine alone, which is all that the page's security policy lets it connect to. */
import { text } from '../../../state/codec.ts';

export const USUAL_ADDRESS = 'ws://127.0.0.1:8765';

const HOSTS = ['127.0.0.1', 'localhost'];

/** Why a server cannot be asked; null where it can. */
export function addressProblem(given: string): string | null {
  const expected = `An address like ${USUAL_ADDRESS} is expected.`;
  if (!URL.canParse(given)) return expected;
  const { protocol, hostname, username, hash } = new URL(given);
  if (protocol !== 'ws:' || username || hash) return expected;
  return HOSTS.includes(hostname)
    ? null
    : 'Only servers of this machine are asked: ws://127.0.0.1 or ws://localhost. One of another machine is reached by a tunnel (ssh -L).';
}

export const address = text(USUAL_ADDRESS, (given) => addressProblem(given) === null);
