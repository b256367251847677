/** The service on Node, Deno and Bun: `PORT`, `HOST`, `CONFIG` and `DATA` of the environment say where. */
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import process from 'node:process';
import { fileURLToPath } from 'node:url';
import { serve } from 'srvx';
import { configOf } from './config.js';
import { limitHalfOpen } from './connections.js';
import { Fleet } from './fleet.js';
import { handlerOf } from './handler.js';
import { Objects } from './local.js';
import { page } from './pages.js';
import { openFiles } from './storage/files.js';
import { makeFolder } from './storage/folder.js';
import { lockFolder } from './storage/lock.js';
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
makeFolder(DATA);
await lockFolder(DATA);
const database = (await openSqlite(join(DATA, 'edge.sqlite'))) ?? openFiles(join(DATA, 'files'));

const fleets = new Objects(database, 'fleet/', (storage) => new Fleet(storage));
/** @param {string} tenant @returns {import('./vehicle.js').FleetPort} */
const fleetOf = (tenant) => ({
  admit: (...given) => fleets.use(tenant, (fleet) => fleet.admit(...given)),
  tell: (...given) => fleets.use(tenant, (fleet) => fleet.tell(...given)),
  quarantine: (...given) => fleets.use(tenant, (fleet) => fleet.quarantine(...given)),
  forget: (...given) => fleets.use(tenant, (fleet) => fleet.forget(...given)),
});
const vehicles = new Objects(database, 'vehicle/', (storage) => new Vehicle(storage, config, fleetOf));

/** @type {import('./handler.js').Service['vehicle']} */
const asked = (ask, request) => vehicles.use(`${ask.tenant}/${ask.vehicle}`, (vehicle) => vehicle.answer(ask, request));

for (const [entry, reason] of database.unreadable) {
  console.error(`${join(DATA, 'files', entry)} cannot be read and is left as it is: ${reason}`);
}
if (database.unreadable.size > 0) {
  // Vehicles that were listed are marked without waiting for a request.
  for (const tenant of Object.keys(config.tenants)) {
    const listed = await fleets.use(tenant, (fleet) => fleet.vehicles()).catch(() => []);
    for (const { vehicle } of listed) {
      if (!database.isUnreadable(`vehicle/${tenant}/${vehicle}`)) continue;
      await asked({ tenant, vehicle, action: 'describe' }, new Request('http://vehicle/'));
    }
  }
}

const { connections, attach } = limitHalfOpen(config.limits.halfOpen);
const handler = handlerOf({
  config,
  connections,
  health: () => ({
    quarantined: vehicles.quarantined.size + fleets.quarantined.size,
    unreadableEntries: database.unreadable.size,
  }),
  vehicle: asked,
  vehicles: (tenant) => fleets.use(tenant, (fleet) => fleet.vehicles()),
  page,
});

const server = serve({
  fetch: handler,
  port: Number(PORT),
  hostname: HOST,
  silent: true,
  // A request may last for days; body.js ends one that says nothing. Its headers may not: their limit would be that of
  // the request, which is none.
  node: {
    requestTimeout: 0,
    headersTimeout: 1000 * config.limits.idleS,
    connectionsCheckingInterval: 250 * config.limits.idleS,
    keepAliveTimeout: 65_000,
  },
  bun: { idleTimeout: 120, maxRequestBodySize: Number.MAX_SAFE_INTEGER },
});
const node = server.node?.server;
if (node) attach(/** @type {import('node:http').Server} */ (node));
await server.ready();
console.log(`listening on ${server.url}`);
