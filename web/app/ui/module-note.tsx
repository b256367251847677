/** Says how far the build of the module that runs networks is, until it is there. */
import { useEffect } from 'preact/hooks';
import { moduleBuild, moduleReady } from '../networks/module.ts';

const minutes = (seconds: number): string => {
  const whole = Math.floor(seconds);
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, '0')} min`;
};

export function ModuleNote() {
  useEffect(() => {
    moduleReady().catch(() => {});
  }, []);
  const build = moduleBuild.value;
  switch (build.state) {
    case 'ready':
      return null;
    case 'failed':
      return (
        <span class="problem" data-module="failed">
          The module that runs networks could not be built: {build.reason}
        </span>
      );
    case 'building':
      return (
        <span data-module="building" title={build.step}>
          The module that runs networks is being built, for {minutes(build.seconds)} so far; a first build takes about
          five. Networks start when it is there.
        </span>
      );
    default:
      return <span data-module="waiting">The module that runs networks is to be built.</span>;
  }
}
