/** The mounting angles of the drive as code. */
import { type Code, inRepository, NEEDS, nothing, type Part, sentences, textOf } from '../../code/code.ts';
import { expression, quoted } from '../../code/literal.ts';
import { flags, withoutDefaults } from '../../code/options.ts';
import { Script } from '../../code/script.ts';
import { command, fileWord, flagged } from '../../code/shell.ts';
import { bundledFiles, type Loaded, loaded, simulation } from './drive/drive.ts';
import { needsNetwork, ownNetwork } from './motion/motion-network.ts';
import { about, WAYS, type Way } from './motion/ways.ts';
import { asked, jointOptions, type Options, optionsOf, results } from './results/process.ts';
import { type MountingState, mountingState } from './state.ts';

const FOLDER = 'recordings/delphi/';
const FOUND = [
  'angleDeg',
  'sigmaDeg',
  'converged',
  'misaligned',
  'scale',
  'scaleSigma',
  'biasDegps',
  'biasSigmaDegps',
  'inlierShare',
] as const;
/** What means something else where it is absent: the drive's own. */
const PLACE = ['xM', 'yM', 'nominalDeg'];

interface Made {
  state: MountingState;
  open: Loaded;
  options: Options;
  ways: Way[];
  lacks: string[];
}

export function mountingCode(): Code {
  if (mountingState.peek().source === 'live')
    return nothing('Live data are not kept. Record them, and calibrate the recording.');
  const open = loaded.peek();
  const options = asked();
  if (!open || !options)
    return nothing('The page shows no angle: no drive is open, or the radar’s place is not known.');
  const shown = WAYS.flatMap((way) => {
    const result = results.peek().get(way);
    return result ? [{ way, result }] : [];
  });
  const made: Made = {
    state: mountingState.peek(),
    open,
    options,
    ways: shown.filter(({ result }) => !result.problem).map(({ way }) => way),
    lacks: [
      ...shown.flatMap(({ way, result }) =>
        result.problem ? [`${about(way).title} is left out, as it did not run: ${result.problem.message}`] : [],
      ),
      'The trajectory and the frames one by one are not in it.',
    ],
  };
  return { javascript: javascript(made), commandLine: commandLine(made) };
}

/** Names of the drive's files as they are found. */
function namesOf({ source, own }: Loaded): string[] {
  if (source === 'delphi') return bundledFiles.map(([name]) => FOLDER + (name.endsWith('.gz') ? name : `${name}.gz`));
  return own.map(({ name }) => name);
}

/** Whether the tables were opened with columns that the user chose. */
const isMapped = ({ files, own }: Loaded): boolean =>
  own.length > 0 && own.some(({ name }) => !files.some((file) => file.name === name));

function driveNeeds(open: Loaded): string {
  if (open.source === 'simulated') return '';
  if (open.source === 'delphi') return inRepository('the drive', FOLDER);
  const names = namesOf(open);
  return isMapped(open)
    ? `Your tables with the columns that you chose, as ${names.join(', ')}: save the session, a ZIP archive with both in its folder mounting.`
    : NEEDS.own(names);
}

const MODEL = 'motion/deepego-plus.bin';

function networkNeeds(options: Options): string {
  const own = needsNetwork(options.motion) ? ownNetwork.peek() : null;
  return own ? NEEDS.own([own.name]) : '';
}

function javascript({ state, open, options, ways, lacks }: Made): Part {
  const script = new Script().use('boresight', 'initDrives').add('await initDrives();', '');
  if (open.source === 'simulated') {
    script.use('boresight', 'simulateDrive');
    script.call('const drive = simulateDrive', withoutDefaults('SimulateDriveOptions', simulation(state), ['seed']));
  } else {
    script.use('node:fs/promises', 'readFile').use('boresight', 'readDrive');
    script.constant('names', namesOf(open));
    script.add(
      'const files = names.map(async (name) => ({ name, bytes: await readFile(name) }));',
      'const drive = readDrive(await Promise.all(files));',
    );
  }
  const withNetwork = needsNetwork(options.motion);
  if (withNetwork) {
    const own = ownNetwork.peek();
    script.use('node:fs/promises', 'readFile');
    script.add(
      own
        ? `const network = await readFile(${quoted(own.name)});`
        : `const network = await readFile(new URL(import.meta.resolve('boresight/models/${MODEL}')));`,
    );
  }
  const { motion: _, ...all } = options;
  script.constant('options', {
    ...withoutDefaults('CalibrationOptions', all, PLACE),
    ...(withNetwork ? { network: expression('network') } : {}),
  });
  script.constant('found', FOUND);
  script.add(
    "console.log('method', ...found, 'used');",
    'const print = (method, { result }) =>',
    '  console.log(method, ...found.map((name) => result[name]), result.frames.used);',
  );
  for (const way of ways) {
    const own = optionsOf(way, options);
    const motion = own.motion === undefined ? {} : { motion: own.motion };
    if (way !== 'joint') {
      script.use('boresight', 'calibrateDrive');
      const given = literalOptions({ method: way, ...motion });
      script.add(`print('${way}', calibrateDrive(drive, { ...options, ${given} }));`);
      continue;
    }
    script.use('boresight', 'jointCalibration');
    const { sensors, ...common } = jointOptions(open.drive, own);
    script.constant('together', {
      sensors,
      ...withoutDefaults('CalibrationOptions', common),
      ...(needsNetwork(own.motion) ? { network: expression('network') } : {}),
    });
    script.add(
      'const all = jointCalibration(drive, together);',
      `print('joint', all.find(({ sensor }) => sensor === ${options.sensor}));`,
    );
  }
  const needs = sentences(NEEDS.package, driveNeeds(open), networkNeeds(options));
  return { text: script.text(), needs, lacks };
}

const literalOptions = (options: Record<string, string>): string =>
  Object.entries(options)
    .map(([key, value]) => `${key}: ${quoted(value)}`)
    .join(', ');

function commandLine({ state, open, options, ways, lacks }: Made): Part {
  const lines: string[] = [];
  const not: string[] = [];
  if (open.source === 'simulated') {
    const { seed, misalignmentDeg = {}, ...rest } = simulation(state);
    lines.push(
      command([
        ...['boresight', 'simulate', 'drive', '--seed', String(seed), ...flags('SimulateDriveOptions', rest)],
        ...Object.entries(misalignmentDeg).flatMap(([id, deg]) => ['--misalign', `${id}=${deg}`]),
        ...['--out', 'drive'],
      ]),
    );
    not.push('The drive is written in single precision, as the format has it: angles differ by some 0.000001°.');
  }
  const log = open.source === 'simulated' ? ['drive'] : namesOf(open).map(fileWord);
  for (const way of ways) {
    const { sensor, ...own } = optionsOf(way, options);
    const network = needsNetwork(own.motion) ? ownNetwork.peek() : null;
    const words = ['boresight', 'calibrate', ...log, '--sensor', String(sensor)];
    if (way === 'joint') {
      if (needsNetwork(own.motion) || state.xM !== null || state.yM !== null || state.nominal !== null) {
        not.push(
          `${about(way).title}: on the command line it takes no network, and the place of each radar from the drive.`,
        );
        continue;
      }
      const { xM: _, yM: __, nominalDeg: ___, ...common } = own;
      lines.push(command([...words, '--joint', ...flags('CalibrationOptions', common), '--json']));
    } else {
      lines.push(
        command([
          ...words,
          ...flags('CalibrationOptions', { method: way, ...own }, PLACE),
          ...(network ? flagged('network', fileWord(network.name)) : []),
          '--json',
        ]),
      );
    }
  }
  const needs = sentences(
    NEEDS.program,
    driveNeeds(open),
    networkNeeds(options),
    open.source === 'simulated' ? 'It writes the folder drive.' : '',
  );
  return { text: textOf(lines), needs, lacks: [...not, ...lacks] };
}
