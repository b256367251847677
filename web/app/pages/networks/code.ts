/** The scene that a network is tried on, as code. */
import type { SceneSampling } from 'boresight';
import { type Code, NEEDS, nothing, type Part, sentences, textOf } from '../../code/code.ts';
import { expression } from '../../code/literal.ts';
import { modelNeeds, modelWords, NetworkCode } from '../../code/networks.ts';
import { flags, withoutDefaults } from '../../code/options.ts';
import { Script } from '../../code/script.ts';
import { command } from '../../code/shell.ts';
import { type Model, sightOf } from '../../networks/models.ts';
import { attempt, COUNT_RULES, regionCalls, type Scene, selected, snapshotCalls, targetsIn } from './attempt.ts';
import { cubeOptions, radarOf } from './region.ts';
import { networksState } from './state.ts';

const LACKS = ['Cards, experiments and times are not in it.'];

export function networksCode(): Code {
  const model = selected.peek();
  if (!model) return nothing('No network is chosen.');
  const scene: Scene = networksState.peek();
  const onRegion = sightOf(model.card) === 'region';
  const failed = (attempt.peek()?.rows ?? []).flatMap(({ title, problem }) =>
    problem ? [`${title} did not run on the page: ${problem.message}`] : [],
  );
  const lacks = [...failed, ...LACKS];
  return onRegion
    ? { javascript: regionScript(model, scene, lacks), commandLine: NO_REGION }
    : { javascript: snapshotScript(model, scene, lacks), commandLine: snapshotCommands(model, scene, lacks) };
}

/** A line for each source. */
const PRINTER = [
  'function print(method, { sources }) {',
  '  for (const { azimuthDeg, powerDb } of sources) console.log(method, azimuthDeg, powerDb);',
  '}',
];

const array = { array: expression('array') };

function begun(...names: string[]): Script {
  return new Script().use('boresight', 'init', ...names).add('await init();');
}

const needsOf = (networks: NetworkCode): string => sentences(NEEDS.package, networks.needs());

function snapshotScript(model: Model, scene: Scene, lacks: string[]): Part {
  const { simulation, options, fieldOfViewDeg, beside, array: name } = snapshotCalls(model.card, scene);
  const { array: _, targets, ...request } = simulation;
  const { array: __, ...told } = options;
  const script = begun('estimate', 'simulateSnapshots');
  const networks = new NetworkCode(script, [model]);
  script.add('');
  script.constant('array', name);
  script.call('const { data, shape, truth } = simulateSnapshots', {
    ...array,
    targets: withoutDefaults('SceneSampling', targets),
    ...withoutDefaults('SnapshotRequest', request, ['seed']),
  });
  script.add('// Elements x snapshots of the only scene.', 'const snapshots = { data, shape: shape.slice(1) };');
  script.call('console.log', 'method', 'azimuthDeg', 'powerDb');
  script.add(
    "for (const { azimuthDeg, powerDb } of truth[0]) console.log('truth', azimuthDeg, powerDb);",
    ...PRINTER,
    '',
  );
  const estimator = withoutDefaults('SharedEstimatorOptions', told);
  script.constant('options', { ...array, ...estimator });
  const network = networks.open(model, { options: expression('...options'), fieldOfViewDeg });
  script.add(`print('${model.card.network}', ${network}.estimate({ snapshots }));`);
  script.constant('methods', [...beside]);
  script.add('for (const method of methods) print(method, estimate({ snapshots }, { method, ...options }));');
  return { text: script.text(), needs: needsOf(networks), lacks };
}

const DATA = 'snapshots.npy';

function snapshotCommands(model: Model, scene: Scene, lacks: string[]): Part {
  const { simulation, options, fieldOfViewDeg, beside } = snapshotCalls(model.card, scene);
  const { array: name, targets, ...request } = simulation;
  const { array: _, ...told } = options;
  const words = ['--array', String(name)];
  const estimate = (method: string, ...more: string[]): string =>
    command(['boresight', 'estimate', DATA, ...words, '--method', method, ...more, '--json']);
  const lines = [
    command([
      ...['boresight', 'simulate', 'snapshots', ...words],
      ...flags('SceneSampling', targets as SceneSampling, ['count'], 'random-'),
      ...flags('SnapshotRequest', request, ['seed']),
      ...['--out', DATA],
    ]),
    estimate(model.card.network, ...modelWords(model), ...flags('SharedEstimatorOptions', { ...told, fieldOfViewDeg })),
    ...beside.map((method) => estimate(method, ...flags('SharedEstimatorOptions', told))),
  ];
  const written = `It writes ${DATA}, and snapshots.json, which has the truth.`;
  return { text: textOf(lines), needs: sentences(NEEDS.program, modelNeeds([model]), written), lacks };
}

const NO_REGION: Part = {
  text: '',
  needs: '',
  lacks: [
    'The command line takes no single region of interest: its command regions finds regions in captures and cubes.',
  ],
};

function regionScript(model: Model, scene: Scene, lacks: string[]): Part {
  const { card } = model;
  const radar = radarOf(card);
  const targets = targetsIn(scene, card);
  const {
    array: name,
    targets: those,
    ...request
  } = cubeOptions(radar, targets, scene.snr, scene.seed, scene.range === 'together');
  const script = begun('simulateCube', 'strongestRegion', 'waveformPreset');
  const networks = new NetworkCode(script, [model]);
  script.add('');
  script.constant('array', name);
  script.call('const cube = simulateCube', {
    waveform: expression(`waveformPreset('${radar.waveform}')`),
    ...array,
    ...withoutDefaults('CubeRequest', request, ['seed']),
    targets: those.map((target) => withoutDefaults('CubeTarget', target, ['azimuthDeg'])),
  });
  script.add('const { region, covariance, snapshots } = strongestRegion(cube);');
  script.add('const [bins, , chirps] = region.shape;');
  script.add('const input = { covariance, snapshotCount: bins * chirps };', '');
  if (card.network === 'counting') {
    script.use('boresight', 'countSources');
    const network = networks.open(model);
    script.add(`const { sources, probability } = ${network}.count(input);`);
    script.add("console.log('network', sources, ...probability);");
    for (const { criterion, forwardBackward } of COUNT_RULES) {
      const name = `${criterion}${forwardBackward ? '-reversed' : ''}`;
      const options = withoutDefaults('CountOptions', { criterion, forwardBackward }, ['criterion']);
      const given = Object.entries(options).map(
        ([key, value]) => `${key}: ${typeof value === 'string' ? `'${value}'` : value}`,
      );
      script.add(`console.log('${name}', countSources(input, { ${given.join(', ')} }).count);`);
    }
    return { text: script.text(), needs: needsOf(networks), lacks };
  }
  const { ofNetwork, beside } = regionCalls(radar.array, targets, scene.refine);
  const { array: _, ...told } = ofNetwork;
  script.use('boresight', 'estimate').add(...PRINTER);
  const network = networks.open(model, { ...array, ...withoutDefaults('SharedEstimatorOptions', told) });
  script.add(`print('${card.network}', ${network}.estimateRegion(region));`);
  for (const { method, of, options } of beside) {
    const { array: _, ...own } = options;
    script.call(`const ${variable(method)} = estimate`, expression(of === 'covariance' ? 'input' : '{ snapshots }'), {
      method,
      ...array,
      ...withoutDefaults('SharedEstimatorOptions', own),
    });
    script.add(`print('${method}', ${variable(method)});`);
  }
  return { text: script.text(), needs: needsOf(networks), lacks };
}

const variable = (method: string): string => method.replaceAll(/-(.)/g, (_, letter: string) => letter.toUpperCase());
