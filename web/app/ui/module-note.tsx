/** Says that the module that runs networks is being built, where the site does not have it yet. */
import { useEffect } from 'preact/hooks';
import { hasModule, moduleReady } from '../networks/module.ts';

export function ModuleNote() {
  useEffect(() => {
    void moduleReady();
  }, []);
  if (hasModule) return null;
  return (
    <span data-module="building">
      The module that runs networks is being built, which takes about five minutes the first time. The page reloads when
      it is ready; the terminal of <code>npm start</code> reports errors.
    </span>
  );
}
