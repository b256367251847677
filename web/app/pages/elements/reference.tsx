/** What the manifest says of the element that is shown. */
import { told } from './state.ts';

function Rows({ title, of }: { title: string; of: readonly { name: string; type?: string; description: string }[] }) {
  if (!of.length) return null;
  return (
    <>
      <h4>{title}</h4>
      <dl class="told">
        {of.map(({ name, type, description }) => (
          <div key={name}>
            <dt>
              <code>{name}</code>
              {type && <span class="muted"> {type}</span>}
            </dt>
            <dd>{description}</dd>
          </div>
        ))}
      </dl>
    </>
  );
}

export function Reference() {
  const { tag, attributes, properties, events } = told.value;
  return (
    <section class="panel" aria-label={`What ${tag} is given and tells`}>
      <div class="panel-head">
        <h3>What it is given and tells</h3>
      </div>
      <div class="prose">
        <Rows title="Properties" of={properties} />
        <Rows title="Attributes" of={attributes} />
        <Rows title="Events" of={events} />
      </div>
    </section>
  );
}
