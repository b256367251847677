// Modules that runtimes bring, as far as they are used here, and what build.mjs makes.
declare module 'cloudflare:workers' {
  export class DurableObject {
    constructor(context: unknown, env: unknown);
  }
}
declare module 'bun:sqlite' {
  export class Database {
    constructor(path: string);
  }
}
