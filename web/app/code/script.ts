/** An ES module for Node, put together line by line. */
import { call, literal } from './literal.ts';

const COLUMNS = 100;

/** Its imports follow from what is used. */
export class Script {
  readonly #imports = new Map<string, Set<string>>();
  readonly #lines: string[] = [];

  /** Names that a module is to give. */
  use(module: string, ...names: string[]): this {
    const before = this.#imports.get(module) ?? new Set();
    for (const name of names) before.add(name);
    this.#imports.set(module, before);
    return this;
  }

  add(...lines: string[]): this {
    this.#lines.push(...lines);
    return this;
  }

  /** `const name = value;` */
  constant(name: string, value: unknown): this {
    const start = `const ${name} = `;
    return this.add(`${start}${literal(value, { before: start.length })};`);
  }

  /** `start(values)`, such as `const { sources } = estimate(input, options);`. */
  call(start: string, ...values: unknown[]): this {
    return this.add(call(start, values));
  }

  text(): string {
    const order = (name: string): string => `${name.startsWith('node:') ? 0 : 1}${name}`;
    const imports = [...this.#imports]
      .sort(([a], [b]) => (order(a) < order(b) ? -1 : 1))
      .map(([module, names]) => {
        const sorted = [...names].sort((a, b) => (a.toLowerCase() < b.toLowerCase() ? -1 : 1));
        const line = `import { ${sorted.join(', ')} } from '${module}';`;
        return line.length <= COLUMNS
          ? line
          : `import {\n${sorted.map((name) => `  ${name},\n`).join('')}} from '${module}';`;
      });
    return `${[...imports, '', ...this.#lines].join('\n')}\n`;
  }
}
