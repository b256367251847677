/** One network's card: what it takes and gives, how it was trained, how well it does. */

import type { CardPort } from 'boresight';
import { useMemo } from 'preact/hooks';
import { count, fixed } from '../../../plots/format.ts';
import { markers } from '../../../plots/layers.ts';
import { toCsv } from '../../../plots/save.ts';
import { methodStyle, type SeriesStyle } from '../../../plots/theme.ts';
import { type Card, type Leg, type Model, sightOf } from '../../networks/models.ts';
import { PlotFrame } from '../../ui/plot-frame.tsx';
import { hoursText, METRICS, made, metricText, sizeOf, taskOf, trainedOn } from './words.ts';

export function CardPanel({ model }: { model: Model }) {
  const { card, title } = model;
  const facts: [string, string, string][] = [
    ['Parameters', card.parameters === undefined ? '–' : count(card.parameters), 'Numbers that training found'],
    ['File', sizeOf(card), 'ONNX; fetched when the network is first used'],
    ['Samples seen', card.samplesSeen === undefined ? '–' : count(card.samplesSeen), 'All simulated'],
    ['Training', card.hours === undefined ? '–' : hoursText(card.hours), hardwareOf(card)],
    [
      'Least confidence',
      card.confidence === undefined ? '–' : fixed(card.confidence, 3),
      'What a source must have to be reported, unless the number of sources is known',
    ],
  ];
  return (
    <section class="panel" aria-labelledby="card-title" data-card={model.name}>
      <div class="panel-head">
        <h3 id="card-title">{title}</h3>
        <span class="tools">
          {model.address && (
            <a class="button" href={model.address} download={`${model.name}.onnx`}>
              ONNX
            </a>
          )}
          {model.cardAddress && (
            <a class="button" href={model.cardAddress} download={`${model.name}.json`}>
              Card
            </a>
          )}
        </span>
      </div>
      <p class="remark">
        {taskOf(card)}.
        {card.reference && (
          <>
            {' '}
            After <cite>{card.reference}</cite>.
          </>
        )}
      </p>
      {card.architecture && (
        <p class="remark" data-field="architecture">
          <b>What it is.</b> {card.architecture} {card.differences}
        </p>
      )}
      {card.limits && (
        <p class="remark" data-field="limits">
          <b>Limits.</b> {card.limits}
        </p>
      )}
      <dl class="facts flat" data-facts="card">
        {facts.map(([term, value, help]) => (
          <div key={term} title={help}>
            <dt>{term}</dt>
            <dd>{value}</dd>
          </div>
        ))}
      </dl>
      <Ports card={card} />
      <div class="card-details">
        <Pairs title="Trained on simulated" pairs={trainedOn(card)} />
        <Pairs title="Making" pairs={made(card)} />
      </div>
      {card.legs && <Legs legs={card.legs} />}
      {card.sha256 && (
        <p class="remark digest">
          SHA-256 <code>{card.sha256}</code>
        </p>
      )}
      <p class="remark">Licence: MIT or Apache-2.0, as Boresight itself; data and weights are our own.</p>
    </section>
  );
}

function Pairs({ title, pairs }: { title: string; pairs: readonly [string, string][] }) {
  return (
    <div>
      <h4>{title}</h4>
      <table class="data compact pairs">
        <tbody>
          {pairs.map(([name, value]) => (
            <tr key={name}>
              <th scope="row" class="text">
                {name}
              </th>
              <td class="text wrap">{value}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}

const hardwareOf = ({ legs = [] }: Card): string =>
  [...new Set(legs.flatMap(({ hardware }) => hardware ?? []))].join('; ');

/** Runs of training, each of which began with the weights of the one before. */
function Legs({ legs }: { legs: readonly Leg[] }) {
  return (
    <div class="table-scroll" tabIndex={0} role="region" aria-label="Runs of training, scrollable">
      <table class="data compact" data-table="legs">
        <thead>
          <tr>
            <th scope="col" class="text">
              Run of training
            </th>
            <th scope="col" title="Simulated as they were needed; none came twice within a run">
              Samples
            </th>
            <th scope="col">Time</th>
            <th scope="col">Batch</th>
            <th scope="col" title="The highest of its schedule">
              Learning rate
            </th>
            <th scope="col" class="text">
              Hardware
            </th>
          </tr>
        </thead>
        <tbody>
          {legs.map(({ title, samplesSeen, hours, training = {}, hardware }, index) => (
            <tr key={index}>
              <th scope="row" class="text">
                {index + 1}. {title}
              </th>
              <td>{samplesSeen === undefined ? '–' : count(samplesSeen)}</td>
              <td>{hours === undefined ? '–' : hoursText(hours)}</td>
              <td>{typeof training.batch === 'number' ? count(training.batch) : '–'}</td>
              <td>{typeof training.learningRate === 'number' ? training.learningRate : '–'}</td>
              <td class="text wrap">{hardware}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}

function Ports({ card }: { card: Card }) {
  const rows: [string, CardPort][] = [
    ...card.inputs.map((port): [string, CardPort] => ['Input', port]),
    ...card.outputs.map((port): [string, CardPort] => ['Output', port]),
  ];
  return (
    <div class="table-scroll" tabIndex={0} role="region" aria-label="Inputs and outputs, scrollable">
      <table class="data compact">
        <thead>
          <tr>
            <th scope="col" class="text">
              Tensor
            </th>
            <th scope="col" class="text">
              Name
            </th>
            <th scope="col" class="text">
              Shape
            </th>
            <th scope="col" class="text">
              Meaning and units
            </th>
          </tr>
        </thead>
        <tbody>
          {rows.map(([kind, port]) => (
            <tr key={kind + port.name}>
              <th scope="row" class="text">
                {kind}
              </th>
              <td class="text">
                <code>{port.name}</code>
              </td>
              <td class="text">{port.axes.join(' × ')}</td>
              <td class="text wrap">{port.meaning}</td>
            </tr>
          ))}
        </tbody>
      </table>
    </div>
  );
}

type Row = Readonly<Record<string, number | string>>;
const numberOf = (value: number | string | undefined): number | undefined =>
  typeof value === 'number' ? value : undefined;

/** Which metric a plot of a network shows, as series over SNR. */
function curvesOf(card: Card): {
  key: string;
  label: string;
  /** A curve's dash and marker, by their numbers. */
  series: { label: string; look: readonly [dash: number, marker: number]; values: (row: Row) => number | undefined }[];
  rows: readonly Row[][];
} {
  const rows = card.metrics ?? [];
  if (sightOf(card) === 'snapshot') {
    // Of a network for any array each array has its own.
    const arrays = [...new Set(rows.map(({ array }) => array))];
    const curves = arrays.flatMap((array, dash) => {
      const ofArray = rows.filter((row) => row.array === array);
      const numbers = [...new Set(ofArray.map(({ targets }) => Number(targets)))].sort((a, b) => a - b);
      return numbers.map((targets, marker) => ({
        label: `${array === undefined ? '' : `${array}, `}${targets} ${targets === 1 ? 'target' : 'targets'}`,
        look: [arrays.length > 1 ? dash : marker, marker] as const,
        rows: ofArray.filter((row) => row.targets === targets),
      }));
    });
    return {
      key: 'f1',
      label: 'Largest F1',
      rows: curves.map((one) => one.rows),
      series: curves.map(({ label, look }) => ({ label, look, values: ({ f1 }) => numberOf(f1) })),
    };
  }
  const keys = (
    card.network === 'counting'
      ? ['accuracy', 'accuracyOfNone', 'accuracyOfOne', 'accuracyOfTwo']
      : ['within0Deg', 'within1Deg', 'closePairsWithin1Deg', ...(sightOf(card) === 'covariance' ? ['within2Deg'] : [])]
  ).filter((key) => rows.some((row) => key in row));
  return {
    key: keys[0] ?? '',
    label: sightOf(card) === 'covariance' ? 'Share of scenes (%)' : 'Share of regions (%)',
    rows: keys.map(() => [...rows]),
    series: keys.map((key, i) => ({
      label: METRICS[key]?.title ?? key,
      look: [i, i] as const,
      values: (row) => (row[key] === undefined ? undefined : 100 * Number(row[key])),
    })),
  };
}

/** From few targets to many: lighter dashes; one hue, for it is one network. */
const DASHES: readonly (number[] | undefined)[] = [undefined, [9, 3], [6, 3], [3, 3], [1.5, 3]];
const SHAPES = ['diamond', 'circle', 'square', 'up', 'star'] as const;

export function MetricsPanel({ model }: { model: Model }) {
  const { card, name } = model;
  const rows = card.metrics ?? [];
  const plot = useMemo(() => {
    const { series, rows: parts, label } = curvesOf(card);
    const snrs = [...new Set(rows.map(({ snrDb }) => snrDb as number))].sort((a, b) => a - b);
    const lines = series.map((one, i) => {
      const dash = DASHES[one.look[0] % DASHES.length];
      const style: SeriesStyle = {
        color: methodStyle(card.network).color,
        width: 1.8,
        marker: SHAPES[one.look[1] % SHAPES.length] as 'circle',
        ...(dash ? { dash } : {}),
      };
      const y = snrs.map((snr) => {
        const row = parts[i]?.find(({ snrDb }) => snrDb === snr);
        return (row && one.values(row)) ?? null;
      });
      return { id: `${name}-${i}`, label: one.label, y, style };
    });
    const values = lines.flatMap(({ y }) => y).filter((value) => value !== null);
    const low = Math.min(...values);
    const high = sightOf(card) === 'snapshot' ? 1 : 100;
    const margin = Math.max((high - low) * 0.08, high * 0.002);
    return {
      lines,
      snrs,
      label,
      content: {
        x: snrs,
        series: lines,
        extent: {
          x: [Math.min(...snrs) - 1, Math.max(...snrs) + 1] as const,
          y: [low - margin, high + margin] as const,
        },
        above: [
          markers(
            lines.flatMap(({ y, style }) =>
              snrs.flatMap((x, k) => (y[k] == null ? [] : [{ x, y: y[k] as number, style, size: 4 }])),
            ),
          ),
        ],
      },
    };
  }, [card]);
  if (!rows.length) return null;
  const columns = Object.keys(METRICS).filter((key) => rows.some((row) => key in row));
  const csv = (): string =>
    toCsv(
      columns,
      rows.map((row) => columns.map((key) => row[key])),
    );
  return (
    <PlotFrame
      key={name}
      title="How well it does"
      detail={`on ${count(card.metricsExamples ?? 0)} new simulated samples each`}
      name="metrics"
      height="short"
      content={plot.content}
      axes={{ x: { label: 'SNR (dB)', steps: [1, 5, 10] }, y: { label: plot.label } }}
      legend={plot.lines.map(({ id, label, style, y }) => ({
        id,
        label,
        style,
        line: true,
        value: ({ index }) => fixed(y[index ?? -1] ?? Number.NaN, sightOf(card) === 'snapshot' ? 4 : 1),
      }))}
      readout={({ index }) => `SNR ${fixed(plot.snrs[index ?? -1] ?? Number.NaN, 0)} dB`}
      csv={csv}
      fileParts={[name]}
      overlay={
        <details class="table-details" open>
          <summary>As a table</summary>
          <div class="table-scroll capped" tabIndex={0} role="region" aria-label="Metrics, scrollable">
            <table class="data compact" data-table="metrics">
              <thead>
                <tr>
                  {columns.map((key) => (
                    <th key={key} scope="col" title={METRICS[key]?.help}>
                      {METRICS[key]?.title}
                    </th>
                  ))}
                </tr>
              </thead>
              <tbody>
                {rows.map((row, i) => (
                  <tr key={i}>
                    {columns.map((key) => (
                      <td key={key} data-field={key} data-value={row[key]}>
                        {metricText(key, row[key])}
                      </td>
                    ))}
                  </tr>
                ))}
              </tbody>
            </table>
          </div>
        </details>
      }
    />
  );
}
