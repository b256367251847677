/** OpenAPI 3.1 of the routes. Options and results of boresight are described by its own schema (boresight/schema.json). */

const numbers = { type: 'array', items: { type: 'number' } };
const problem = {
  type: 'object',
  required: ['code', 'message', 'details'],
  properties: {
    code: { type: 'string' },
    message: { type: 'string' },
    details: {
      type: 'object',
      properties: { what: { type: 'string' }, expected: { type: 'string' }, given: { type: 'string' } },
    },
  },
};
const frame = {
  type: 'object',
  additionalProperties: false,
  required: ['radar', 'timeS', 'azimuthDeg', 'rangeRateMps', 'yawRateDegps'],
  properties: {
    radar: { type: ['string', 'integer'] },
    timeS: { type: 'number', description: 'ascending for each radar, such as seconds since 1970' },
    azimuthDeg: { ...numbers, description: 'of each detection, in the frame of the radar, positive to the left' },
    rangeRateMps: { ...numbers, description: 'of each detection, positive when receding, not compensated' },
    yawRateDegps: { type: ['number', 'null'] },
    speedMps: { type: ['number', 'null'] },
  },
};
const problems = {
  400: 'malformed',
  401: 'no token of a tenant',
  403: 'a token that may only read',
  429: 'too often',
  503: 'not stored, or quarantined',
};

/** @param {import('./routes.js').Route[]} routes */
export function description(routes) {
  /** @type {Record<string, any>} */
  const paths = {};
  for (const { method, path, role, summary, takes, gives } of routes) {
    const named = [...path.matchAll(/\{(\w+)\}/g)].map(([, name]) => ({
      name,
      in: 'path',
      required: true,
      schema: { type: 'string', minLength: 1, maxLength: 64 },
    }));
    const content = (/** @type {string[]} */ types, /** @type {unknown} */ schema) =>
      Object.fromEntries(types.map((type) => [type, { schema }]));
    const refused = Object.entries(role ? problems : {}).map(([status, text]) => [
      status,
      { description: text, content: content(['application/json'], { $ref: '#/components/schemas/problem' }) },
    ]);
    paths[path] ??= {};
    paths[path][method.toLowerCase()] = {
      summary,
      ...(named.length && { parameters: named }),
      ...(takes && {
        requestBody: {
          required: true,
          content: content(takes, path.endsWith('/frames') ? { $ref: '#/components/schemas/frame' } : {}),
        },
      }),
      security: role ? [{ token: [] }] : [],
      responses: {
        [gives.length ? '200' : '204']: {
          description: summary,
          ...(gives.length && { content: content(gives, {}) }),
        },
        ...Object.fromEntries(refused),
      },
    };
  }
  return {
    openapi: '3.1.0',
    info: { title: 'Boresight edge service', version: '1' },
    components: {
      securitySchemes: { token: { type: 'http', scheme: 'bearer' } },
      schemas: { problem, frame },
    },
    paths,
  };
}
