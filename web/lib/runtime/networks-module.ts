let registered: (() => Promise<WebAssembly.Module>) | undefined;

/** Tells pools where the module of networks is: `boresight/neural` does when it is imported. */
export function registerNetworks(compile: () => Promise<WebAssembly.Module>): void {
  registered = compile;
}

export const registeredNetworks = (): (() => Promise<WebAssembly.Module>) | undefined => registered;
