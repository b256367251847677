/** Asks what the columns of tables are. */
import { useEffect, useRef } from 'preact/hooks';
import { significant } from '../../../../plots/format.ts';
import { FIELDS, type Field, type GroupName } from './fields.ts';
import { lacking } from './guess.ts';
import {
  cancelColumns,
  changePick,
  chooseColumn,
  chooseTable,
  GROUPS,
  type Mapping,
  mapping,
  openAsSaid,
} from './mapping.ts';
import { reader, type Table } from './table.ts';
import { saveTemplate } from './template.ts';

const ROWS = 5;
const HEADINGS: Record<GroupName, string> = { detections: 'Detections', motion: 'Motion of the car' };

export function ColumnsDialog() {
  const dialog = useRef<HTMLDialogElement>(null);
  const asked = mapping.value;
  useEffect(() => {
    if (asked) dialog.current?.showModal();
  }, [asked !== null]);
  if (!asked) return null;
  const lack = lacking(asked.choices);
  return (
    <dialog
      ref={dialog}
      class="question columns"
      aria-labelledby="columns-question"
      onCancel={(event) => {
        event.preventDefault();
        cancelColumns();
      }}
    >
      <h2 id="columns-question">What do the columns hold?</h2>
      <p>
        Azimuths, x and y are seen from the radar, x along its boresight; from x and y follow azimuth and range. Columns
        that nothing is chosen from are not read; rows without a number where one is needed are left out and counted.
        The files stay as they are.
      </p>
      {GROUPS.map((group) => (
        <Group key={group} group={group} asked={asked} />
      ))}
      {asked.tables.map((table) => (
        <FirstRows key={table.name} table={table} />
      ))}
      {asked.problem && (
        <p class="problem" role="alert" data-columns="problem">
          {asked.problem}
        </p>
      )}
      <p class="muted" role="status" data-columns="lacking">
        {lack.length > 0 ? `Still to be chosen: ${lack.join(', ')}.` : ''}
      </p>
      <div class="row">
        <button
          type="button"
          class="primary"
          data-action="open-columns"
          disabled={lack.length > 0 || asked.busy}
          onClick={() => void openAsSaid()}
        >
          {asked.busy ? 'Opening' : 'Open'}
        </button>
        <button type="button" data-action="cancel-columns" onClick={cancelColumns}>
          Cancel
        </button>
        {GROUPS.map((group) => (
          <button
            key={group}
            type="button"
            data-action={`template-${group}`}
            title="A table that opens as it is, to be filled with your own numbers"
            onClick={() => saveTemplate(group)}
          >
            Template of {group}
          </button>
        ))}
      </div>
    </dialog>
  );
}

function Group({ group, asked }: { group: GroupName; asked: Mapping }) {
  const choice = asked.choices[group];
  const table = asked.tables.find(({ name }) => name === choice.table);
  return (
    <fieldset>
      <legend>{HEADINGS[group]}</legend>
      <label>
        Table{' '}
        <select
          name={`${group}-table`}
          value={choice.table ?? ''}
          onChange={(event) => chooseTable(group, event.currentTarget.value)}
        >
          {group === 'motion' && <option value="">none</option>}
          {asked.tables.map(({ name }) => (
            <option key={name} value={name} selected={name === choice.table}>
              {name}
            </option>
          ))}
        </select>
      </label>
      {table && (
        <table class="data compact">
          <thead>
            <tr>
              <th scope="col" class="text">
                What
              </th>
              <th scope="col" class="text">
                Column
              </th>
              <th scope="col" class="text">
                Unit
              </th>
              <th scope="col" class="text">
                Positive
              </th>
              <th scope="col">First row</th>
            </tr>
          </thead>
          <tbody>
            {FIELDS[group].map((field) => (
              <Row key={field.name} group={group} field={field} table={table} asked={asked} />
            ))}
          </tbody>
        </table>
      )}
    </fieldset>
  );
}

function Row({ group, field, table, asked }: { group: GroupName; field: Field; table: Table; asked: Mapping }) {
  const choice = asked.choices[group];
  const pick = choice.picks[field.name];
  const name = `${group}-${field.name}`;
  const first = table.sample[0];
  const value = first && !field.names ? reader(table, field, choice)(first) : Number.NaN;
  const what = `of ${field.label.toLowerCase()}, ${group}`;
  return (
    <tr data-field={name}>
      <th scope="row" class="text">
        {field.label}
        {field.place ? ' (in place of azimuth)' : field.required ? '' : ' (optional)'}
      </th>
      <td class="text">
        <select
          name={name}
          aria-label={`Column ${what}`}
          value={pick?.column ?? ''}
          onChange={(event) => chooseColumn(group, field, event.currentTarget.value)}
        >
          <option value="">–</option>
          {table.columns.map((column) => (
            <option key={column} value={column} selected={column === pick?.column}>
              {column}
            </option>
          ))}
        </select>
      </td>
      <td class="text">
        {pick && field.units.length > 1 ? (
          <select
            name={`${name}-unit`}
            aria-label={`Unit ${what}`}
            value={pick.unit}
            onChange={(event) => changePick(group, field, { unit: event.currentTarget.value })}
          >
            {field.units.map((unit) => (
              <option key={unit.name} value={unit.name} selected={unit.name === pick.unit}>
                {unit.name}
              </option>
            ))}
          </select>
        ) : (
          pick && field.units[0]?.name
        )}
      </td>
      <td class="text">
        {pick && field.signs && (
          <select
            name={`${name}-sign`}
            aria-label={`Positive values ${what}`}
            value={pick.flipped ? 'flipped' : 'same'}
            onChange={(event) => changePick(group, field, { flipped: event.currentTarget.value === 'flipped' })}
          >
            <option value="same" selected={!pick.flipped}>
              {field.signs[0]}
            </option>
            <option value="flipped" selected={pick.flipped}>
              {field.signs[1]}
            </option>
          </select>
        )}
      </td>
      <td>{Number.isFinite(value) ? `${significant(value, 4)} ${field.units[0]?.name ?? ''}` : ''}</td>
    </tr>
  );
}

function FirstRows({ table }: { table: Table }) {
  const title = `First rows of ${table.name}`;
  return (
    <details open>
      <summary>{title}</summary>
      <div class="table-scroll" role="region" aria-label={`${title}, scrollable`} tabIndex={0}>
        <table class="data compact" data-preview={table.name}>
          <thead>
            <tr>
              {table.columns.map((column) => (
                <th key={column} scope="col">
                  {column}
                </th>
              ))}
            </tr>
          </thead>
          <tbody>
            {table.sample.slice(0, ROWS).map((row, i) => (
              <tr key={i}>
                {table.columns.map((column, k) => (
                  <td key={column}>{row[k]}</td>
                ))}
              </tr>
            ))}
          </tbody>
        </table>
      </div>
    </details>
  );
}
