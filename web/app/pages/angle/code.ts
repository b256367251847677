/** The present scene of the angle lab as code. */
import type { EstimatorOptions, Method, SnapshotTarget } from 'boresight';
import { type Code, NEEDS, nothing, type Part, sentences, textOf } from '../../code/code.ts';
import { expression } from '../../code/literal.ts';
import { modelNeeds, modelWords, NetworkCode } from '../../code/networks.ts';
import { flags, pairs, withoutDefaults } from '../../code/options.ts';
import { Script } from '../../code/script.ts';
import { command, heredoc } from '../../code/shell.ts';
import { api } from '../../data.ts';
import type { Model } from '../../networks/models.ts';
import { compared } from './compare.ts';
import { boundOptions, estimatorOptions, networkFor, results, type Scene, scene, simulationOf } from './compute.ts';
import { sweep } from './sweep.ts';

/** A method that the page shows, with what it is called with. */
interface Shown {
  method: Method;
  options: Partial<Omit<EstimatorOptions, 'array' | 'method'>>;
  model: Model | undefined;
}

export function angleCode(): Code {
  const made = scene.peek();
  if (!made) return nothing('The page shows no scene.');
  const problems = api.methods().flatMap(({ name, title }) => {
    const problem = results.peek().get(name)?.problem;
    return problem ? [`${title} is left out, as it did not run: ${problem.message}`] : [];
  });
  const lacks = [
    ...problems,
    ...(compared.kept.peek() ? ['The settings kept as A are not in it, only the present ones, B.'] : []),
    ...(sweep.peek() ? ['The Monte-Carlo runs are not in it.'] : []),
  ];
  return { javascript: javascript(made, lacks), commandLine: commandLine(made, lacks) };
}

function methodsOf({ state, geometry }: Scene): Shown[] {
  return api.methods().flatMap(({ name, network }) => {
    const result = results.peek().get(name);
    if (!result || result.problem) return [];
    const { array: _, method, ...options } = estimatorOptions(name, state);
    const model = network ? networkFor(name, geometry, state) : undefined;
    return [{ method, options: withoutDefaults('SharedEstimatorOptions', options), model }];
  });
}

const targetsOf = (targets: readonly SnapshotTarget[]): object[] =>
  targets.map((target) => withoutDefaults('SnapshotTarget', target, ['azimuthDeg']));

function javascript(made: Scene, lacks: readonly string[]): Part {
  const { state } = made;
  const { array, targets: _, ...simulation } = simulationOf(state);
  const shown = methodsOf(made);
  const script = new Script().use('boresight', 'init', 'simulateSnapshots').add('await init();');
  const networks = new NetworkCode(
    script,
    shown.flatMap(({ model }) => model ?? []),
  );
  script.add('');
  script.constant('array', array);
  script.call('const { data, shape } = simulateSnapshots', {
    array: expression('array'),
    targets: targetsOf(state.targets),
    ...withoutDefaults('SnapshotRequest', simulation, ['seed']),
  });
  script.add('// Elements x snapshots of the only scene.', 'const snapshots = { data, shape: shape.slice(1) };');
  if (made.bound?.length) {
    const { array: _, ...bound } = boundOptions(state, made.snapshots.truth[0]);
    script.use('boresight', 'cramerRaoBound').add('', '// Standard deviations that no unbiased estimator is below.');
    script.call('const bound = cramerRaoBound', {
      array: expression('array'),
      ...withoutDefaults('BoundRequest', bound),
    });
    script.add("console.log('bound', ...bound.azimuthDeg);");
  }
  if (shown.length)
    printer(
      script,
      shown.some(({ model }) => model),
    );
  const plain = shown.filter(({ model }) => !model);
  if (plain[0]) {
    script.use('boresight', 'estimate').add('');
    script.constant('options', { array: expression('array'), ...plain[0].options });
    script.constant(
      'methods',
      plain.map(({ method }) => method),
    );
    script.add('for (const method of methods) print(method, estimate({ snapshots }, { method, ...options }));');
  }
  for (const { method, options, model } of shown) {
    if (!model) continue;
    const network = networks.open(model, { array: expression('array'), ...options });
    script.add(`print('${method}', ${network}.estimate({ snapshots }));`);
  }
  return { text: script.text(), needs: sentences(NEEDS.package, networks.needs()), lacks };
}

/** A line for each source; networks may state deviations too. */
function printer(script: Script, withDeviations: boolean): void {
  const names = ['azimuthDeg', 'powerDb'];
  const deviation = withDeviations ? ', deviation' : '';
  const more = withDeviations ? ", ...(deviation ? ['±', deviation.azimuthDeg, deviation.powerDb] : [])" : '';
  script.add(
    '',
    `console.log('method', ${names.map((name) => `'${name}'`).join(', ')});`,
    'function print(method, { sources }) {',
    `  for (const { ${names.join(', ')}${deviation} } of sources)`,
    `    console.log(method, ${names.join(', ')}${more});`,
    '}',
  );
}

const DATA = 'snapshots.npy';

function commandLine(made: Scene, lacks: readonly string[]): Part {
  const { state } = made;
  const { array, targets: _, ...simulation } = simulationOf(state);
  const file = typeof array === 'string' ? null : 'array.json';
  const words = ['--array', file ?? String(array)];
  const shown = methodsOf(made);
  const lines = [
    ...(file ? [heredoc(file, JSON.stringify(array))] : []),
    command([
      ...['boresight', 'simulate', 'snapshots', ...words],
      ...state.targets.flatMap((target) => ['--target', pairs('SnapshotTarget', target, ['azimuthDeg'])]),
      ...(state.targets.length ? [] : ['--random-count', '0,0']),
      ...flags('SnapshotRequest', simulation, ['seed']),
      ...['--out', DATA],
    ]),
    ...shown.map(({ method, options, model }) =>
      command([
        ...['boresight', 'estimate', DATA, ...words, '--method', method],
        ...(model ? modelWords(model) : []),
        ...flags('SharedEstimatorOptions', options),
        '--json',
      ]),
    ),
  ];
  const models = shown.flatMap(({ model }) => model ?? []);
  const files = [file, DATA, 'snapshots.json'].filter(Boolean);
  return {
    text: textOf(lines),
    needs: sentences(NEEDS.program, modelNeeds(models), `It writes ${files.join(', ')}.`),
    lacks: [...lacks, ...(made.bound?.length ? ['The bound is not on the command line.'] : [])],
  };
}
