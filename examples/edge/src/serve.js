/** The service on Node, Deno and Bun: `PORT`, `HOST`, `CONFIG` and `DATA` of the environment say where. */
import { mkdirSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import process from 'node:process';
import { fileURLToPath } from 'node:url';
import { serve } from 'srvx';
import { configOf } from './config.js';
import { Fleet } from './fleet.js';
import { handlerOf } from './handler.js';
import { Objects } from './local.js';
import { page } from './pages.js';
import { openFiles } from './storage/files.js';
import { openSqlite } from './storage/sqlite.js';
import { Vehicle } from './vehicle.js';

const here = fileURLToPath(new URL('..', import.meta.url));
const {
  PORT = '8080',
  HOST = '127.0.0.1',
  CONFIG = join(here, 'config.json'),
  DATA = join(here, 'data'),
} = process.env;

const config = configOf(readFileSync(CONFIG, 'utf8'));
mkdirSync(DATA, { recursive: true });
const database = (await openSqlite(join(DATA, 'edge.sqlite'))) ?? openFiles(join(DATA, 'files'));

const fleets = new Objects(database, 'fleet/', (storage) => new Fleet(storage));
/** @param {string} tenant @returns {import('./vehicle.js').FleetPort} */
const fleetOf = (tenant) => ({
  admit: (...given) => fleets.use(tenant, (fleet) => fleet.admit(...given)),
  tell: (...given) => fleets.use(tenant, (fleet) => fleet.tell(...given)),
  forget: (...given) => fleets.use(tenant, (fleet) => fleet.forget(...given)),
});
const vehicles = new Objects(database, 'vehicle/', (storage) => new Vehicle(storage, config, fleetOf));

const handler = handlerOf({
  config,
  vehicle: (ask, request) => vehicles.use(`${ask.tenant}/${ask.vehicle}`, (vehicle) => vehicle.answer(ask, request)),
  vehicles: (tenant) => fleets.use(tenant, (fleet) => fleet.vehicles()),
  page,
});

const server = serve({
  fetch: handler,
  port: Number(PORT),
  hostname: HOST,
  silent: true,
  // A request may last for days; body.js ends one that says nothing.
  node: { requestTimeout: 0, keepAliveTimeout: 65_000 },
  bun: { idleTimeout: 120, maxRequestBodySize: Number.MAX_SAFE_INTEGER },
});
await server.ready();
console.log(`listening on ${server.url}`);
