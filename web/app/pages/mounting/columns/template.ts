/** Tables that open as they are, to be filled with one's own numbers. */
import { download, fileName } from '../../../../plots/save.ts';
import { FIELDS, type GroupName } from './fields.ts';

export function saveTemplate(group: GroupName): void {
  const fields = FIELDS[group].filter(({ place }) => !place);
  const rows = [0, 1].map((row) => fields.map(({ examples }) => examples[row]));
  const lines = [fields.map(({ name }) => name), ...rows].map((row) => `${row.join(',')}\n`);
  download(lines.join(''), fileName(['template', group], 'csv'));
}
