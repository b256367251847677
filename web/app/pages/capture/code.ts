/** The shown frame of the capture as code. */
import type { AngleOptions, ChainOptions, Method } from 'boresight';
import { boardLogName, captureNeeds, captureWords, openCapture } from '../../code/captures.ts';
import { type Code, NEEDS, nothing, type Part, sentences, textOf } from '../../code/code.ts';
import { expression, quoted } from '../../code/literal.ts';
import { modelNeeds, modelWords, NetworkCode } from '../../code/networks.ts';
import { flags, withoutDefaults } from '../../code/options.ts';
import { Script } from '../../code/script.ts';
import { command, fileWord, heredoc } from '../../code/shell.ts';
import { api } from '../../data.ts';
import type { Model } from '../../networks/models.ts';
import { compared } from './compare/compare.ts';
import { cellResults, networkFor, result, type Shown } from './detections/process.ts';
import { boardLog } from './files/files.ts';
import { shownCell } from './plots/view.ts';
import { regions, type Trio, trio } from './regions/regions.ts';
import { type CaptureState, captureState, cellAngle, chainOptions, regionOptions } from './state.ts';

interface CellMethod {
  method: Method;
  model: Model | undefined;
}

/** All that the code is made of. */
interface Made {
  shown: Shown;
  state: CaptureState;
  chain: ChainOptions;
  /** Of the chain's method. */
  model: Model | undefined;
  cell: { rangeBin: number; dopplerBin: number; frame?: number };
  angle: AngleOptions;
  methods: CellMethod[];
  trio: { networks: Trio; frame: number } | null;
  lacks: string[];
}

const CALIBRATION = 'array.calibration.json';

const ROW = ['rangeM', 'rateMps', 'azimuthDeg', 'elevationDeg', 'xM', 'yM', 'zM', 'powerDb', 'snrDb'] as const;

export function captureCode(): Code {
  const shown = result.peek();
  if (!shown) return nothing('The page shows no detections.');
  const state = captureState.peek();
  const { frame, view } = shown;
  const chain = chainOptions(state);
  const isNetwork = (method: Method | undefined): boolean =>
    api.methods().some(({ name, network }) => name === method && network);
  const modelOf = (method: Method | undefined): Model | undefined =>
    method && isNetwork(method) ? networkFor(method, state) : undefined;
  const results = api.methods().flatMap(({ name, title }) => {
    const one = cellResults.peek().get(name);
    return one ? [{ method: name, title, model: modelOf(name), problem: one.problem }] : [];
  });
  const networks = trio.peek();
  const found = regions.peek();
  const made: Made = {
    shown,
    state,
    chain,
    model: modelOf(chain.angle?.method),
    cell: { ...shownCell(view, state.cell), ...(frame === 'all' ? {} : { frame }) },
    angle: cellAngle(state),
    methods: results.filter(({ problem }) => !problem),
    trio: found && networks && typeof networks !== 'string' ? { networks, frame: found.frame } : null,
    lacks: [
      ...results.flatMap(({ title, problem }) =>
        problem ? [`${title} is left out of the cell, as it did not run: ${problem.message}`] : [],
      ),
      ...(compared.kept.peek() ? ['The settings kept as A are not in it, only the present ones, B.'] : []),
      ...(shown.capture.simulated
        ? ['The capture was simulated in the page: save its .bin and .cfg under Files.']
        : []),
      'The profiles over time and the range-azimuth map are not in it.',
    ],
  };
  return { javascript: javascript(made), commandLine: commandLine(made) };
}

/** The networks that are used, each once. */
const modelsOf = ({ model, methods, trio }: Made): Model[] => [
  ...new Set([
    ...(model ? [model] : []),
    ...methods.flatMap((one) => one.model ?? []),
    ...(trio ? [trio.networks.counting, trio.networks.one, trio.networks.two] : []),
  ]),
];

function javascript(made: Made): Part {
  const { shown, state, model, methods, lacks } = made;
  const { calibration } = made.chain;
  const { capture, frame } = shown;
  const script = new Script().use('boresight', 'init').add('await init();');
  const models = modelsOf(made);
  const networks = new NetworkCode(script, models);
  script.add('');
  openCapture(script, capture);
  script.add('');
  const calibrated = typeof calibration === 'object';
  if (calibrated) {
    script.add('// What is taken off gain and phase of each channel.');
    script.constant('calibration', calibration);
  }
  const named = calibrated ? { calibration: expression('calibration') } : {};
  script.constant('chain', withoutDefaults('DetectionOptions', { ...made.chain, ...named }));
  if (model) {
    const network = networks.open(model);
    script.add(
      frame === 'all'
        ? `const { detections } = ${network}.combineFrames(bin, cfg, chain);`
        : `const [{ detections }] = ${network}.processFrames(bin, cfg, chain, ${frame});`,
    );
  } else
    script.add(
      `const { detections } = capture.${frame === 'all' ? 'combineFrames(chain)' : `processFrame(${frame}, chain)`};`,
    );
  script.constant('columns', ROW);
  script.add(
    "console.log('detection', ...columns);",
    "for (const row of detections) console.log('detection', ...columns.map((name) => row[name]));",
  );
  const log = boardLogName(capture);
  const index = boardIndex(state);
  if (log !== null && index !== null) {
    script.use('boresight', 'parseBoardLog');
    script.add('', '// What the board itself reported.');
    script.add(`const dat = await readFile(${quoted(log)});`, 'const { frames } = parseBoardLog(dat, cfg);');
    script.add(`for (const { rangeM, rateMps, azimuthDeg } of frames[${index}].objects)`);
    script.add("  console.log('board', rangeM, rateMps, azimuthDeg);");
  }
  if (methods.length) cells(script, made, networks);
  if (made.trio) {
    const { networks: three, frame: at } = made.trio;
    script.add('', '// Regions of the range spectrum, and the targets in each.');
    const [counting, one, two] = [three.counting, three.one, three.two].map((network) => networks.open(network));
    script.constant('regionOptions', withoutDefaults('RegionChainOptions', { ...regionOptions(state), ...named }));
    script.add(
      `const [{ regions }] = ${counting}.captureRegions(`,
      `  { one: ${one}, two: ${two} },`,
      ...['bin', 'cfg', 'regionOptions', String(at)].map((name) => `  ${name},`),
      ');',
      'for (const { rangeM, coarseAzimuthDeg, sources, targets } of regions)',
      '  console.log(',
      "    'region',",
      '    rangeM,',
      '    coarseAzimuthDeg,',
      '    sources,',
      '    ...targets.map(({ azimuthDeg }) => azimuthDeg),',
      '  );',
    );
  }
  return { text: script.text(), needs: sentences(NEEDS.package, captureNeeds(capture), networks.needs()), lacks };
}

/** Angles in the chosen cell. */
function cells(script: Script, { cell, angle, methods, chain }: Made, networks: NetworkCode): void {
  const options = withoutDefaults('DetectionOptions.angle', angle);
  script.add('', '// Angles in the chosen cell.');
  script.constant('cell', cell);
  script.add(
    'function print(method, { sources }) {',
    '  for (const { azimuthDeg, powerDb } of sources) console.log(method, azimuthDeg, powerDb);',
    '}',
  );
  const plain = methods.filter(({ model }) => !model).map(({ method }) => method);
  if (plain.length) {
    script.constant('methods', plain);
    const more = Object.keys(options).length;
    if (more) script.constant('angle', options);
    script.add(
      'for (const method of methods)',
      `  print(method, capture.cellSpectrum(cell, { method${more ? ', ...angle' : ''} }, chain));`,
    );
  }
  for (const { method, model } of methods) {
    if (!model) continue;
    const array = chain.array ?? { positions: expression('capture.info.array.positions') };
    const network = networks.open(model, { array, ...options });
    script.add(`print('${method}', ${network}.estimate({ snapshots: capture.cellSnapshots(cell, chain) }));`);
  }
}

/** The frame of the board's log that is shown. */
function boardIndex({ board }: CaptureState): number | null {
  const frames = boardLog.peek()?.frames.length ?? 0;
  if (!frames) return null;
  return board === 'last' ? frames - 1 : Math.min(Number(board), frames - 1);
}

function commandLine(made: Made): Part {
  const { shown, state, model, methods, lacks } = made;
  const { capture, frame } = shown;
  const { before, words } = captureWords(capture);
  const { array, angle = {}, calibration, ...detection } = made.chain;
  const arrays = [
    ...(array === undefined ? [] : ['--array', String(array)]),
    ...(calibration === undefined ? [] : ['--calibration', calibration === 'none' ? 'none' : CALIBRATION]),
  ];
  const log = boardLogName(capture);
  const lines = [
    ...before,
    ...(typeof calibration === 'object' ? [heredoc(CALIBRATION, JSON.stringify(calibration, null, 1))] : []),
    command([
      ...['boresight', 'estimate', ...words, ...arrays],
      ...(frame === 'all' ? ['--all'] : ['--frame', String(frame)]),
      ...flags('DetectionOptions', detection),
      ...flags('DetectionOptions.angle', angle),
      ...(model ? modelWords(model) : []),
      '--json',
    ]),
    ...(log === null ? [] : [command(['boresight', 'estimate', fileWord(log), '--json'])]),
  ];
  if (made.trio) {
    const { networks, frame: at } = made.trio;
    const { array: _, calibration: __, ...options } = regionOptions(state);
    lines.push(
      command([
        ...['boresight', 'regions', ...words, ...arrays, '--frame', String(at)],
        ...(['counting', 'one', 'two'] as const).flatMap((name) => modelWords(networks[name], name)),
        ...flags('RegionChainOptions', options),
        '--json',
      ]),
    );
  }
  const used = [...(model ? [model] : []), ...(made.trio ? Object.values(made.trio.networks) : [])];
  return {
    text: textOf(lines),
    needs: sentences(NEEDS.program, captureNeeds(capture), modelNeeds(used)),
    lacks: [
      'Transforms are in single precision, and the command line plans them otherwise: angles may differ by some 0.01°, levels by some 0.01 dB, most by far less.',
      ...(methods.length ? ['The command line estimates no angles in a cell of one’s own choice.'] : []),
      ...lacks,
    ],
  };
}
