/** The bird's-eye images as code: how clean they are, and what they are made of. */
import type { Gate, ImageFrom, Method } from 'boresight';
import { captureNeeds, openCapture } from '../../code/captures.ts';
import { type Code, NEEDS, nothing, type Part, sentences, textOf } from '../../code/code.ts';
import { expression, literal } from '../../code/literal.ts';
import { modelNeeds, modelWords, NetworkCode } from '../../code/networks.ts';
import { flags, withoutDefaults } from '../../code/options.ts';
import { Script } from '../../code/script.ts';
import { command } from '../../code/shell.ts';
import { api } from '../../data.ts';
import type { Model } from '../../networks/models.ts';
import type { Loaded } from '../capture/files/files.ts';
import { chainOptions, grid, type Input, input, type Radar, shownRadars, streetOptions } from './input.ts';
import { imageOptions, images, isPending, networkFor } from './process.ts';
import { type BirdseyeState, birdseyeCodec, birdseyeState } from './state.ts';

interface Image {
  method: Method;
  title: string;
  from: ImageFrom | undefined;
  angle: object;
  gate: Gate | undefined;
  model: Model | undefined;
}

interface Made {
  state: BirdseyeState;
  looked: Input;
  radars: readonly Radar[];
  list: Image[];
  lacks: string[];
}

export function birdseyeCode(): Code {
  const looked = input.peek();
  const radars = shownRadars.peek();
  const [first] = radars;
  const state = birdseyeState.peek();
  if (!looked || !first) return nothing('The page shows no image.');
  const shown = api.methods().flatMap((info) => {
    const image = images.peek().get(info.name);
    return image ? [{ info, image }] : [];
  });
  const list = shown.flatMap(({ info, image }): Image[] => {
    if (image.problem || (looked.street && !image.gate)) return [];
    const { from, angle = {} } = imageOptions(info.name, first, state);
    // The radar says its field of view.
    const { method: _, fieldOfViewDeg: __, ...rest } = angle;
    return [
      {
        method: info.name,
        title: info.title,
        from,
        angle: rest,
        gate: image.gate,
        model: info.network ? networkFor(info.name) : undefined,
      },
    ];
  });
  const lacks = [
    ...shown.flatMap(({ info, image }) =>
      image.problem ? [`${info.title} is left out, as it did not run: ${image.problem.message}`] : [],
    ),
    ...(shown.some(({ image }) => isPending(image))
      ? ['The page is still computing: what is not there yet may be missing.']
      : []),
  ];
  const made: Made = { state, looked, radars, list, lacks };
  return { javascript: javascript(made), commandLine: looked.street ? streetCommands(made) : captureCommands() };
}

const modelsOf = (list: readonly Image[]): Model[] => [...new Set(list.flatMap(({ model }) => model ?? []))];

/** Of the image, where the truth is known. */
const MEASURES = ['outsideDb', 'peakOutsideDb', 'litOutside', 'litTargets'];

function javascript(made: Made): Part {
  const { state, looked, radars, list, lacks } = made;
  const [first] = radars as [Radar];
  const script = new Script().use('boresight', 'birdsEyeView', 'imagePlan', 'init', 'rangeAzimuthMap');
  script.add('await init();');
  const networks = new NetworkCode(script, modelsOf(list));
  script.add('');
  const { waveform: _, array: __, ...chain } = chainOptions(first, state);
  const detection = withoutDefaults('DetectionOptions', chain);
  if (looked.street) street(script, made, detection);
  else if (looked.capture) capture(script, made, looked.capture, detection);
  script.constant('grid', grid.peek());
  if (looked.street) script.use('boresight', 'sidelobeMeasure').constant('gate', list[0]?.gate);
  imageFunction(script, looked.street !== null, list);
  script.add('');
  script.call('console.log', 'method', ...(looked.street ? MEASURES : []), ...COUNTS);
  for (const { method, from, angle, model } of list)
    script.call('image', method, from, angle, ...(model ? [expression(networks.open(model))] : []));
  const own = looked.capture ? captureNeeds(looked.capture) : '';
  return { text: script.text(), needs: sentences(NEEDS.package, own, networks.needs()), lacks };
}

const COUNTS = ['cells', 'directions', 'unresolved', 'offMap'];

/** The function that makes an image, and prints how clean it is. */
function imageFunction(script: Script, measured: boolean, list: readonly Image[]): void {
  const isNetwork = list.some(({ model }) => model);
  const estimator = list.every(({ model }) => model) ? 'network' : 'network ?? new Estimator(plan.estimator)';
  if (list.some(({ model }) => !model)) script.use('boresight', 'Estimator');
  script.add(
    '',
    `function image(method, from, options${isNetwork ? ', network' : ''}) {`,
    '  const parts = frames.map(({ radar, cells }) => {',
    '    const { waveform, array, fieldOfViewDeg, mounting } = radar;',
    '    const angle = { method, ...options, fieldOfViewDeg };',
    '    const plan = imagePlan({ waveform, array, from, angle, grid: { fieldOfViewDeg } });',
    ...(isNetwork
      ? ['    network?.setOptions(plan.estimator);', `    const estimator = ${estimator};`]
      : ['    const estimator = new Estimator(plan.estimator);']),
    "    const spectra = plan.from === 'spectra';",
    '    const estimates = estimator.estimateBatch({ snapshots: cells.snapshots }, { spectra });',
    `    ${isNetwork ? 'if (estimator !== network) ' : ''}estimator.free();`,
    '    const map = rangeAzimuthMap({ cells, estimates, from: plan.from, grid: plan.grid });',
    '    return { map, mounting, estimates };',
    '  });',
    '  const view = birdsEyeView({ radars: parts.map(({ map, mounting }) => ({ map, mounting })), grid });',
  );
  if (measured) {
    script.add('  const measure = sidelobeMeasure(view, seen, gate);');
    script.add(`  const measures = [${MEASURES.map((name) => `'${name}'`).join(', ')}].map((name) => measure[name]);`);
  }
  script.add(
    '  const sum = (of) => parts.reduce((total, part) => total + of(part), 0);',
    '  console.log(',
    '    method,',
    ...(measured ? ['    ...measures,'] : []),
    '    sum(({ estimates }) => estimates.cells),',
    '    sum(({ estimates }) => estimates.cell.length),',
    '    sum(({ estimates }) => estimates.unresolved),',
    '    sum(({ map }) => map.outside.count),',
    '  );',
    '  return view;',
    '}',
  );
}

function street(script: Script, { state, radars }: Made, detection: object): void {
  script.use('boresight', 'frameCells', 'simulateStreet', 'streetScene');
  script.constant('street', streetOptions(state));
  script.constant(
    'names',
    radars.map(({ name }) => name),
  );
  const chain = { waveform: expression('waveform'), array: expression('array'), ...detection };
  const start = '  const chain = ';
  script.add(
    'const frames = names.map((name) => {',
    '  const { cube, radar, targets } = simulateStreet({ ...street, radar: name });',
    '  const { waveform, array } = radar;',
    `${start}${literal(chain, { indent: '  ', before: start.length })};`,
    '  return { radar, targets, cells: frameCells(cube, chain) };',
    '});',
    '// Points that some radar sees count once.',
    'const { targets } = streetScene(street);',
    'const numbers = frames.flatMap((frame) => frame.targets.map(({ target }) => target));',
    'const seen = [...new Set(numbers)].map((number) => targets[number]);',
  );
}

function capture(script: Script, { state, radars }: Made, open: Loaded, detection: object): void {
  const [radar] = radars as [Radar];
  openCapture(script, open);
  const { info } = open;
  if (info.config.array) script.add('const { waveform, array } = capture.info.config;');
  else {
    script.add('const { waveform } = capture.info.config;', 'const { tx, rx } = capture.info.array;');
    script.add('const array = { tx, rx };');
  }
  script.add('// A capture says nothing of a car: its radar stands at the origin.');
  script.constant('radar', {
    waveform: expression('waveform'),
    array: expression('array'),
    mounting: radar.mounting,
    fieldOfViewDeg: radar.fieldOfViewDeg,
  });
  script.call('const cells = capture.frameCells', Math.min(state.frame, info.frames - 1), {
    array: expression('array'),
    ...detection,
  });
  script.add('const frames = [{ radar, cells }];');
}

/** Settings that the command line has no options for, by what they are called on the page. */
const FIXED: readonly [keyof BirdseyeState, string][] = [
  ['falseAlarm', 'the false-alarm rate'],
  ['grouping', 'one cell a peak'],
  ['sources', 'the directions a cell'],
  ['points', 'the points of the spectra'],
  ['refine', 'the refinement'],
  ['gate', 'the radius of targets'],
];

function streetCommands({ state, radars, list, lacks }: Made): Part {
  const others = FIXED.filter(([key]) => state[key] !== birdseyeCodec.defaults[key]).map(([, title]) => title);
  if (others.length) {
    const why = `The command line makes images with the settings of a fresh visit alone; it has no option for ${others.join(', ')}.`;
    return { text: '', needs: '', lacks: [why] };
  }
  // From directions, the field of view decides which there are.
  const spectra = list.filter(({ from }) => from === 'spectra');
  const left = list.filter(({ from }) => from !== 'spectra').map(({ title }) => title);
  const models = modelsOf(spectra);
  const lines = spectra.map(({ method, model }) =>
    command([
      ...['boresight', 'image', 'street', ...flags('StreetOptions', streetOptions(state), ['seed'])],
      ...['--radars', radars.map(({ name }) => name).join(','), '--method', method],
      ...(model ? modelWords(model) : []),
      ...['--from', 'spectra', ...flags('ViewGrid', grid.peek()), '--json'],
    ]),
  );
  return {
    text: textOf(lines),
    needs: lines.length ? sentences(NEEDS.program, modelNeeds(models)) : '',
    lacks: [
      'The command line looks for directions up to 90° to each side, the page within the field of view of each radar.',
      ...(lines.length
        ? ['Measures of images from spectra therefore differ by some 0.01 dB, shares by some 0.3 %.']
        : []),
      ...(left.length ? [`Images of the directions found differ by more, and are not in it: ${left.join(', ')}.`] : []),
      ...(lines.length
        ? ['The command line does not tell how many directions there are, nor how many cells are unresolved.']
        : []),
      ...lacks,
    ],
  };
}

const captureCommands = (): Part => ({
  text: '',
  needs: '',
  lacks: [
    'The command line makes images of captures on a ground and with a field of view of its own, other than here.',
  ],
});
