/** The service's addresses: what each does, who may ask, and how the API's description tells it. */
import { angles, detections, mountingAngle } from './answers.js';
import { METRICS_TYPE, openMetrics } from './metrics.js';
import { description } from './openapi.js';
import { json } from './reply.js';

/** @typedef {{ request: Request, names: { vehicle?: string, radar?: string }, tenant: string, service: import('./handler.js').Service }} Call */
/**
 * @typedef {object} Route
 * @property {string} method
 * @property {string} path with names in braces
 * @property {'read' | 'write' | null} role null for everybody
 * @property {string} summary
 * @property {string[]} [takes] types of the body
 * @property {string[]} gives types of the answer
 * @property {true} [streams] whether the body may last
 * @property {(call: Call) => Response | Promise<Response>} run
 */

const JSON_TYPE = 'application/json';
const vehicle = '/v1/vehicles/{vehicle}';

/** @param {import('./vehicle.js').Ask['action']} action @returns {Route['run']} */
const ofVehicle =
  (action) =>
  ({ request, names: { vehicle = '', radar }, tenant, service }) =>
    service.vehicle({ tenant, vehicle, action, ...(radar !== undefined && { radar }) }, request);

/** @type {Route[]} */
export const routes = [
  {
    method: 'POST',
    path: '/v1/estimate',
    role: 'write',
    summary: 'Angles of snapshots or of a covariance.',
    takes: [JSON_TYPE],
    gives: [JSON_TYPE],
    run: ({ request, service }) => angles(request, service.config.limits),
  },
  {
    method: 'POST',
    path: '/v1/capture',
    role: 'write',
    summary:
      "Detections of a frame of a capture: a form with the board's bytes (capture), its .cfg (config) and options.",
    takes: ['multipart/form-data'],
    gives: [JSON_TYPE],
    run: ({ request, service }) => detections(request, service.config.limits),
  },
  {
    method: 'POST',
    path: '/v1/calibrate',
    role: 'write',
    summary: 'The mounting angle of frames that are all in the body.',
    takes: [JSON_TYPE],
    gives: [JSON_TYPE],
    run: ({ request, service }) => mountingAngle(request, service.config.limits),
  },
  {
    method: 'GET',
    path: '/v1/vehicles',
    role: 'read',
    summary: 'All vehicles, as each told last (some seconds ago at most).',
    gives: [JSON_TYPE],
    run: async ({ tenant, service }) => json({ vehicles: await service.vehicles(tenant) }),
  },
  {
    method: 'GET',
    path: vehicle,
    role: 'read',
    summary: 'A vehicle: its radars with angles, histories and counts.',
    gives: [JSON_TYPE],
    run: ofVehicle('describe'),
  },
  {
    method: 'DELETE',
    path: vehicle,
    role: 'write',
    summary: 'Forgets a vehicle.',
    gives: [],
    run: ofVehicle('forget'),
  },
  {
    method: 'PUT',
    path: `${vehicle}/radars/{radar}`,
    role: 'write',
    summary: 'Begins the calibration of a radar with its options.',
    takes: [JSON_TYPE],
    gives: [JSON_TYPE],
    run: ofVehicle('configure'),
  },
  {
    method: 'DELETE',
    path: `${vehicle}/radars/{radar}`,
    role: 'write',
    summary: 'Forgets a radar.',
    gives: [],
    run: ofVehicle('forgetRadar'),
  },
  {
    method: 'POST',
    path: `${vehicle}/frames`,
    role: 'write',
    summary: 'Takes frames, one a line, as long as they come. What is answered as accepted is kept.',
    takes: ['application/x-ndjson', 'application/jsonl'],
    streams: true,
    gives: [JSON_TYPE],
    run: ofVehicle('take'),
  },
  {
    method: 'GET',
    path: '/metrics',
    role: 'read',
    summary: 'OpenMetrics of all vehicles.',
    gives: [METRICS_TYPE],
    run: async ({ tenant, service }) =>
      new Response(openMetrics(await service.vehicles(tenant), service.connections), {
        headers: { 'content-type': METRICS_TYPE },
      }),
  },
  {
    method: 'GET',
    path: '/openapi.json',
    role: null,
    summary: 'This description.',
    gives: [JSON_TYPE],
    run: () => json(description(routes)),
  },
  {
    method: 'GET',
    path: '/health',
    role: null,
    summary: 'Whether the service is there, and how much of what is stored cannot be read.',
    gives: [JSON_TYPE],
    run: ({ service }) => json({ ok: true, ...service.health?.() }),
  },
  {
    method: 'GET',
    path: '/',
    role: null,
    summary: 'The page.',
    gives: ['text/html'],
    run: ({ service }) => service.page('/'),
  },
  {
    method: 'GET',
    path: '/page/{file}',
    role: null,
    summary: "The page's files.",
    gives: ['text/javascript', 'text/css'],
    run: ({ request, service }) => service.page(new URL(request.url).pathname),
  },
];
