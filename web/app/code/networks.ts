/** Networks in code: where their files are, and how they are opened. */
import { files } from '../../../package.json';
import type { Model } from '../networks/models.ts';
import { inRepository, NEEDS, sentences } from './code.ts';
import { expression, quoted } from './literal.ts';
import type { Script } from './script.ts';
import { fileWord } from './shell.ts';

type Place = 'package' | 'repository' | 'own';

/** The package has some of the models; the repository has all. */
const isPackaged = (path: string): boolean =>
  files.some((pattern) => pattern.endsWith('*') && path.startsWith(pattern.slice(0, -1)));

function placeOf({ name, folder }: Model): Place {
  if (!folder) return 'own';
  return isPackaged(`${folder}${name}.onnx`) ? 'package' : 'repository';
}

/** Names of a network's files. A user's own card is called as its network. */
function filesOf({ name, address, hasCard, card }: Model): { onnx: string; card: string | null } {
  const onnx = address ? `${name}.onnx` : card.name;
  return { onnx, card: hasCard ? onnx.replace(/(\.onnx)?$/i, '.json') : null };
}

/** Words of the command line for the network of a method. */
export function modelWords(model: Model, flag = 'model'): string[] {
  const { onnx } = filesOf(model);
  return [`--${flag}`, model.folder ? `${model.folder}${onnx}` : fileWord(onnx)];
}

/** What networks need on the command line. */
export function modelNeeds(models: readonly Model[]): string {
  const own = models.filter(({ address }) => !address).map((model) => filesOf(model).onnx);
  return sentences(
    ...[...new Set(models.flatMap(({ folder }) => folder ?? []))].map((folder) => inRepository('networks', folder)),
    own.length ? NEEDS.own(own) : '',
  );
}

/** The networks of a script. */
export class NetworkCode {
  readonly #script: Script;
  readonly #models: readonly Model[];
  #opened = 0;

  /** Puts down what comes before the first of them. */
  constructor(script: Script, models: readonly Model[]) {
    this.#script = script;
    this.#models = models;
    if (!models.length) return;
    script.use('boresight/neural', 'initNeural', 'Network').use('node:fs/promises', 'readFile');
    script.add('await initNeural();');
    if (models.some((model) => placeOf(model) === 'package'))
      script.add("const packaged = (file) => readFile(new URL(import.meta.resolve('boresight/models/' + file)));");
  }

  /** Opens one with options; gives the name of its variable. */
  open(model: Model, options: object = {}): string {
    this.#opened += 1;
    const name = this.#opened === 1 ? 'network' : `network${this.#opened}`;
    const { onnx, card } = filesOf(model);
    const place = placeOf(model);
    const read = (file: string): string =>
      place === 'package'
        ? `await packaged(${quoted(file)})`
        : `await readFile(${quoted(`${model.folder ?? ''}${file}`)})`;
    this.#script.call(`const ${name} = new Network`, expression(read(onnx)), {
      ...(card && { card: expression(`String(${read(card)})`) }),
      ...options,
    });
    return name;
  }

  /** What these networks need beside the package. */
  needs(): string {
    const outside = this.#models.filter((model) => placeOf(model) !== 'package');
    return modelNeeds(outside);
  }
}
