import { Problem } from './reply.js';

/** @param {string} hex */
const bytesOf = (hex) => Uint8Array.from(hex.match(/../g) ?? [], (pair) => Number.parseInt(pair, 16));

/** Whether two digests are equal, in a time that does not tell where they differ. @param {Uint8Array} a @param {Uint8Array} b */
function equal(a, b) {
  let differs = a.length ^ b.length;
  for (let i = 0; i < a.length; i++) differs |= (a[i] ?? 0) ^ (b[i] ?? 0);
  return differs === 0;
}

/**
 * Tells tenants by their bearer tokens, of which the settings have digests alone.
 *
 * @param {import('./config.js').Config} config
 */
export function tokensOf(config) {
  const known = Object.entries(config.tenants).flatMap(([tenant, { tokens }]) =>
    tokens.map(({ sha256, role }) => ({ tenant, role, digest: bytesOf(sha256) })),
  );
  /** @param {Request} request */
  return async (request) => {
    const given = /^bearer ([\x21-\x7e]{1,512})$/i.exec(request.headers.get('authorization') ?? '')?.[1];
    const digest = new Uint8Array(await crypto.subtle.digest('SHA-256', new TextEncoder().encode(given ?? '')));
    let found;
    // All are compared, so that the time tells nothing of which.
    for (const one of known) if (equal(one.digest, digest)) found = one;
    if (found && given !== undefined) return found;
    throw new Problem(
      401,
      'unauthorized',
      { what: 'authorization', expected: 'a bearer token of a tenant', given: given ? 'another' : 'none' },
      { headers: { 'www-authenticate': given ? 'Bearer error="invalid_token"' : 'Bearer' } },
    );
  };
}
