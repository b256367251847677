/** The service on workerd: an object a vehicle, and one a tenant. */
import { DurableObject } from 'cloudflare:workers';
import { configOf } from './config.js';
import { Fleet } from './fleet.js';
import { handlerOf } from './handler.js';
import { page } from './pages.js';
import { durableStorage } from './storage/durable.js';
import { Vehicle } from './vehicle.js';

/** @typedef {{ CONFIG: unknown, VEHICLES: any, FLEETS: any }} Bindings */

/** Says what is asked of a vehicle. Set on every request that is passed on, whatever came with it. */
const ASK = 'x-boresight-ask';

/** @param {any} namespace @param {string} name */
const objectOf = (namespace, name) => namespace.get(namespace.idFromName(name));

export class VehicleObject extends DurableObject {
  #vehicle;

  /** @param {any} context @param {Bindings} env */
  constructor(context, env) {
    super(context, env);
    this.#vehicle = new Vehicle(durableStorage(context), configOf(env.CONFIG), (tenant) =>
      objectOf(env.FLEETS, tenant),
    );
  }

  /** @param {Request} request */
  fetch(request) {
    return this.#vehicle.answer(JSON.parse(decodeURIComponent(request.headers.get(ASK) ?? '')), request);
  }

  alarm() {
    return this.#vehicle.alarm();
  }
}

export class FleetObject extends DurableObject {
  #fleet;

  /** @param {any} context @param {Bindings} env */
  constructor(context, env) {
    super(context, env);
    this.#fleet = new Fleet(durableStorage(context));
  }

  /** @param {Parameters<Fleet['admit']>} given */
  admit(...given) {
    return this.#fleet.admit(...given);
  }

  /** @param {Parameters<Fleet['tell']>} given */
  tell(...given) {
    return this.#fleet.tell(...given);
  }

  /** @param {Parameters<Fleet['quarantine']>} given */
  quarantine(...given) {
    return this.#fleet.quarantine(...given);
  }

  /** @param {Parameters<Fleet['forget']>} given */
  forget(...given) {
    return this.#fleet.forget(...given);
  }

  vehicles() {
    return this.#fleet.vehicles();
  }
}

/** @type {((request: Request) => Promise<Response>) | undefined} */
let handler;

export default {
  /** @param {Request} request @param {Bindings} env */
  fetch(request, env) {
    handler ??= handlerOf({
      config: configOf(env.CONFIG),
      vehicle: (ask, given) => {
        const passed = new Request('https://vehicle/', given);
        passed.headers.set(ASK, encodeURIComponent(JSON.stringify(ask)));
        return objectOf(env.VEHICLES, `${ask.tenant}/${ask.vehicle}`).fetch(passed);
      },
      vehicles: (tenant) => objectOf(env.FLEETS, tenant).vehicles(),
      page,
    });
    return handler(request);
  },
};
