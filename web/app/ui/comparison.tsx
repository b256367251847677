/** A and B of a page: the buttons, in what their settings differ, and a place for what comes of it. */
import type { ComponentChildren } from 'preact';
import type { Problem } from '../data.ts';
import { announce } from '../state/announce.ts';
import type { Comparison } from '../state/comparison.ts';

export function KeepButton<S>({ of }: { of: Comparison<S> }) {
  if (of.kept.value) return null;
  return (
    <button
      type="button"
      slot="actions"
      class="plain"
      data-action="keep-a"
      title="Keep these settings and their results as A, and go on changing B beside them"
      onClick={() => {
        of.keep();
        announce('These settings are A; what you change now is B.', 0);
      }}
    >
      Keep as A
    </button>
  );
}

export function ComparisonPanel<S>({
  of,
  problem,
  children,
}: {
  of: Comparison<S>;
  problem: Problem | null;
  children: ComponentChildren;
}) {
  if (!of.kept.value) return null;
  const settings = of.differences.value;
  return (
    <section class="panel" aria-labelledby="compare-title" data-table="compare">
      <div class="panel-head">
        <h3 id="compare-title">A, kept, and B, the present settings</h3>
        <div class="tools">
          <button
            type="button"
            data-action="keep-a"
            title="Keep B as A in place of what is A now"
            onClick={() => of.keep()}
          >
            Keep B as A
          </button>
          <button
            type="button"
            data-action="swap"
            title="Change B to what A is, and keep what B is as A"
            onClick={() => of.swap()}
          >
            Swap
          </button>
          <button type="button" data-action="drop-a" title="Show B alone" onClick={() => of.drop()}>
            Drop A
          </button>
        </div>
      </div>
      {problem && (
        <p class="alert" role="alert" data-error={problem.code}>
          <strong>A cannot be computed.</strong> {problem.message} <code>{problem.code}</code>
        </p>
      )}
      <div class="table-scroll" tabIndex={0} role="region" aria-label="A and B, scrollable">
        <table class="data">
          <thead>
            <tr>
              {['Setting', 'A', 'B'].map((title) => (
                <th key={title} scope="col" class="text">
                  {title}
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            {settings.map(({ key, name, a, b }) => (
              <tr key={key} data-setting={key}>
                <th scope="row" class="text">
                  {name}
                </th>
                <td class="text">{a}</td>
                <td class="text">{b}</td>
              </tr>
            ))}
            {!settings.length && (
              <tr>
                <td class="text muted" colSpan={3}>
                  None differs yet: change a setting, and B goes away from A.
                </td>
              </tr>
            )}
          </tbody>
        </table>
        {children}
      </div>
    </section>
  );
}
