/** Said first: what networks are for, where they win and where they lose. */
import { useMemo } from 'preact/hooks';
import { titleOf } from './methods.ts';
import { results } from './results.ts';
import { type Standing, standing, TASKS, type Task } from './standing.ts';

export function StandingPanel() {
  return (
    <section class="panel" aria-labelledby="standing-title" data-table="standing">
      <div class="panel-head">
        <h3 id="standing-title">What they are for, and where they win and lose</h3>
      </div>
      <ul class="standings">
        {TASKS.map((task) => (
          <Row key={task.name} task={task} />
        ))}
      </ul>
      <p class="remark">
        The best network against the best classical method, condition by condition of the experiments below.
      </p>
    </section>
  );
}

function Row({ task }: { task: Task }) {
  const all = results.value;
  const found = useMemo(() => all && standing(task, all), [all, task]);
  return (
    <li data-task={task.name}>
      <p>{task.title}</p>
      {found ? <Share {...found} /> : <span class="share" />}
      <p class="small muted">{found ? inWords(task, found) : all ? 'No network is in these results.' : 'Counting'}</p>
    </li>
  );
}

const PARTS = ['ahead', 'level', 'behind'] as const;

/** The same as lengths; the words say it too. */
function Share(found: Standing) {
  return (
    <span class="share" aria-hidden="true">
      {PARTS.map((part) => found[part] > 0 && <span key={part} class={part} style={{ flexGrow: found[part] }} />)}
    </span>
  );
}

function inWords({ by }: Task, { network, rival, ...found }: Standing): string {
  const total = PARTS.reduce((sum, part) => sum + found[part], 0);
  const said = PARTS.filter((part) => found[part] > 0).map((part) => `${part} in ${found[part]}`);
  return `${titleOf(network)}: of ${total} conditions ${said.join(', ')}${rival ? `, most often of ${titleOf(rival)}` : ''} (${by}).`;
}
