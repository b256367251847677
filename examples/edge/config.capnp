# The service by workerd alone: `npm run workerd`. What vehicles keep is under data/workerd.
using Workerd = import "/workerd/workerd.capnp";

const config :Workerd.Config = (
  services = [
    (name = "main", worker = .edge),
    (name = "data", disk = (path = "data/workerd", writable = true)),
    # The service asks nothing of other hosts.
    (name = "internet", network = (allow = [])),
  ],
  sockets = [(name = "http", address = "127.0.0.1:8080", http = (), service = "main")],
);

const edge :Workerd.Worker = (
  compatibilityDate = "2025-09-01",
  modules = [
    (name = "worker.js", esModule = embed "dist/worker/worker.js"),
    (name = "boresight_bg.wasm", wasm = embed "dist/worker/boresight_bg.wasm"),
    (name = "boresight_drives_bg.wasm", wasm = embed "dist/worker/boresight_drives_bg.wasm"),
  ],
  bindings = [
    (name = "CONFIG", json = embed "config.json"),
    (name = "VEHICLES", durableObjectNamespace = "VehicleObject"),
    (name = "FLEETS", durableObjectNamespace = "FleetObject"),
  ],
  durableObjectNamespaces = [
    (className = "VehicleObject", uniqueKey = "boresight-vehicle", enableSql = true),
    (className = "FleetObject", uniqueKey = "boresight-fleet", enableSql = true),
  ],
  durableObjectStorage = (localDisk = "data"),
);
