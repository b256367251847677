/** The one fetch handler of all runtimes. */
import { Bucket } from './bucket.js';
import { isName } from './frame.js';
import { Problem, refusal } from './reply.js';
import { routes } from './routes.js';
import { tokensOf } from './tokens.js';

/**
 * What a runtime gives the handler.
 *
 * @typedef {object} Service
 * @property {import('./config.js').Config} config
 * @property {(ask: import('./vehicle.js').Ask, request: Request) => Promise<Response>} vehicle
 * @property {(tenant: string) => Promise<import('./metrics.js').Vehicles>} vehicles
 * @property {(path: string) => Response} page
 * @property {import('./metrics.js').Connections} [connections] where the runtime counts them
 * @property {() => Record<string, number>} [health] counts that /health tells
 */

const paths = [...new Set(routes.map(({ path }) => path))].map((path) => ({
  parts: path.split('/'),
  methods: routes.filter((route) => route.path === path),
}));

/** A body of this size or less is read even where it is refused, so that the connection can be used again. */
const SMALL_BYTES = 1 << 16;

/** Whether a request may have a large body that nobody has read. @param {Request} request */
const isUnread = ({ bodyUsed, headers }) =>
  !bodyUsed && (headers.has('transfer-encoding') || Number(headers.get('content-length') ?? 0) > SMALL_BYTES);

/** How long a connection whose body is not read is left to the client to close. */
const LINGER_MS = 1000;

/**
 * A body that ends some time after its last byte. Where a server closes a connection on which a client still sends, the
 * client may not see the answer.
 *
 * @param {Response} response
 */
function lingering(response) {
  let over = false;
  return new ReadableStream({
    async start(controller) {
      const bytes = new Uint8Array(await response.arrayBuffer());
      if (over) return;
      controller.enqueue(bytes);
      setTimeout(() => over || controller.close(), LINGER_MS);
    },
    cancel() {
      over = true;
    },
  });
}

/** What a request's path is of, and the names in it. @param {string} url */
function matched(url) {
  // A host may be one that no address has.
  if (!URL.canParse(url)) {
    throw new Problem(400, 'malformed-url', {
      what: 'the address',
      expected: 'a host and a path',
      given: 'something else',
    });
  }
  const given = new URL(url).pathname.split('/');
  const found = paths.find(
    ({ parts }) =>
      parts.length === given.length && parts.every((part, i) => (part.startsWith('{') ? given[i] : part === given[i])),
  );
  if (!found) throw new Problem(404, 'not-found', { what: 'path', expected: 'one of /openapi.json', given: 'another' });
  const names = found.parts.flatMap((part, i) =>
    part.startsWith('{') ? [[part.slice(1, -1), named(given[i] ?? '')]] : [],
  );
  return { methods: found.methods, names: Object.fromEntries(names) };
}

/** @param {string} encoded */
function named(encoded) {
  let name = '';
  try {
    name = decodeURIComponent(encoded);
  } catch {}
  if (isName(name)) return name;
  const expected = '1 to 64 characters, no control characters and no slash';
  throw new Problem(400, 'malformed-name', { what: 'a name in the path', expected, given: 'something else' });
}

/**
 * @param {Service} service
 * @param {() => number} [now]
 * @returns {(request: Request) => Promise<Response>}
 */
export function handlerOf(service, now = Date.now) {
  const { origins, limits } = service.config;
  const tenantOf = tokensOf(service.config);
  /** What a tenant uses of its limits: requests with one answer, and bodies of frames. @typedef {{ bucket: Bucket, open: number }} Use */
  /** @type {Map<string, { requests: Use, streams: Use }>} */
  const tenants = new Map();
  const unused = () => ({ bucket: new Bucket(limits.requests, now()), open: 0 });

  /** @param {Request} request */
  async function answer(request) {
    const { methods, names } = matched(request.url);
    const allowed = [
      ...methods.map(({ method }) => method),
      ...(methods.some(({ method }) => method === 'GET') ? ['HEAD'] : []),
      'OPTIONS',
    ];
    const allow = allowed.join(', ');
    if (request.method === 'OPTIONS') {
      return new Response(null, {
        status: 204,
        headers: {
          allow,
          'access-control-allow-methods': allow,
          'access-control-allow-headers': 'authorization, content-type',
          'access-control-max-age': '600',
        },
      });
    }
    const method = request.method === 'HEAD' ? 'GET' : request.method;
    const route = methods.find((one) => one.method === method);
    if (!route) {
      const details = { what: 'method', expected: allow, given: request.method.slice(0, 32) };
      throw new Problem(405, 'method-not-allowed', details, { headers: { allow } });
    }
    if (!route.role) return route.run({ request, names, tenant: '', service });
    const { tenant, role } = await tenantOf(request);
    if (route.role === 'write' && role === 'read') {
      throw new Problem(403, 'forbidden', {
        what: 'the token',
        expected: 'one that may write',
        given: 'one that reads',
      });
    }
    const uses = tenants.get(tenant) ?? { requests: unused(), streams: unused() };
    tenants.set(tenant, uses);
    // Vehicles that send frames for days leave room for others to ask.
    const [use, most, what] = route.streams
      ? [uses.streams, limits.streams, 'bodies of frames']
      : [uses.requests, limits.open, 'requests'];
    use.bucket.take(1, now(), `${what} of the tenant`);
    if (use.open >= most) {
      const details = { what: `open ${what}`, expected: `${most} at most`, given: 'more' };
      throw new Problem(429, 'too-many-requests', details, { headers: { 'retry-after': '1' } });
    }
    use.open += 1;
    try {
      return await route.run({ request, names, tenant, service });
    } finally {
      use.open -= 1;
    }
  }

  /** Who else may read the answer. @param {Request} request @returns {[string, string][]} */
  const shared = (request) => {
    const origin = request.headers.get('origin');
    const any = origins.includes('*');
    if (!origin || !(any || origins.includes(origin))) return origins.length > 0 && !any ? [['vary', 'origin']] : [];
    return [
      ['access-control-allow-origin', any ? '*' : origin],
      ['access-control-expose-headers', 'retry-after, allow'],
      ...(any ? [] : /** @type {[string, string][]} */ ([['vary', 'origin']])),
    ];
  };

  return async (request) => {
    const response = await answer(request).catch(refusal);
    const headers = new Headers(response.headers);
    if (!headers.has('cache-control')) headers.set('cache-control', 'no-store');
    headers.set('x-content-type-options', 'nosniff');
    // A server reads the rest of a body before the next request of its connection.
    const closes = response.status >= 400 && isUnread(request);
    if (closes) headers.set('connection', 'close');
    for (const [name, value] of shared(request)) headers.set(name, value);
    if (!headers.has('access-control-allow-origin')) {
      for (const name of [...headers.keys()]) if (name.startsWith('access-control-')) headers.delete(name);
    }
    const body = closes ? lingering(response) : response.body;
    return new Response(request.method === 'HEAD' ? null : body, { status: response.status, headers });
  };
}
