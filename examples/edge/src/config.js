/** The settings of the service: config.json, or what the platform binds as CONFIG. */

const DEFAULTS = {
  /** Origins of other pages that may ask, or '*'. */
  origins: /** @type {string[]} */ ([]),
  /** How long a vehicle is kept after its last frame. */
  retentionDays: 30,
  limits: {
    /** Of a request with one answer. */
    bodyBytes: 8 << 20,
    /** Of a line of frames. */
    lineBytes: 256 << 10,
    detections: 4096,
    /** Of a vehicle. */
    radars: 16,
    /** How far a frame may lie ahead of the one before it. */
    aheadS: 30 * 86_400,
    /** Longest wait for the next piece of a body. */
    idleS: 30,
    /** Of one call of boresight; docs/javascript.md says what they are. */
    operations: 5e8,
    callBytes: 64 << 20,
    /** Of a tenant: requests, and bodies of frames, counted separately. */
    requests: { perS: 100, burst: 1000 },
    /** Of a tenant at once: requests, and bodies of frames, which may last for days. */
    open: 256,
    streams: 2048,
    /** Connections that have not sent a request yet, on Node. */
    halfOpen: 2048,
    /** Lines of a vehicle. */
    frames: { perS: 400, burst: 20_000 },
  },
};

/** @typedef {{ sha256: string, role: 'read' | 'write' }} Token */
/** @typedef {{ tokens: Token[], vehicles?: number }} Tenant */
/** @typedef {typeof DEFAULTS & { tenants: Record<string, Tenant> }} Config */
/** @typedef {Config['limits']} Limits */

/**
 * The settings with defaults for what is not given; throws where one is not what it should be.
 *
 * @param {any} given
 * @returns {Config}
 */
export function configOf(given) {
  const { tenants = {}, ...rest } = typeof given === 'string' ? JSON.parse(given) : given;
  const config = /** @type {Config} */ ({ ...merged(DEFAULTS, rest, 'config'), tenants });
  for (const [name, { tokens, vehicles = 1000 }] of Object.entries(config.tenants)) {
    if (!/^[a-z0-9-]{1,64}$/.test(name)) throw new Error(`tenant ${name}: expected small letters, digits and hyphens`);
    if (!(Number.isInteger(vehicles) && vehicles > 0)) throw new Error(`tenant ${name}: vehicles is ${vehicles}`);
    for (const { sha256, role } of tokens) {
      if (!/^[0-9a-f]{64}$/.test(sha256)) throw new Error(`tenant ${name}: a token's sha256 has 64 hexadecimal digits`);
      if (role !== 'read' && role !== 'write') throw new Error(`tenant ${name}: a token's role is read or write`);
    }
  }
  return config;
}

/** @param {any} defaults @param {any} given @param {string} path @returns {any} */
function merged(defaults, given, path) {
  for (const name of Object.keys(given)) if (!(name in defaults)) throw new Error(`${path}.${name} is not a setting`);
  const entries = Object.entries(defaults).map(([name, value]) => {
    const own = given[name];
    if (own === undefined) return [name, value];
    if (Array.isArray(value)) {
      if (!Array.isArray(own)) throw new Error(`${path}.${name} is a list`);
      return [name, own];
    }
    if (typeof value === 'object') return [name, merged(value, own, `${path}.${name}`)];
    if (!(typeof own === 'number' && own > 0)) throw new Error(`${path}.${name} is a number greater than 0`);
    return [name, own];
  });
  return Object.fromEntries(entries);
}
