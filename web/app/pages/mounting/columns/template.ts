/** Tables that open as they are, to be filled with one's own numbers. */
import { download, fileName } from '../../../plots/save.ts';
import { FIELDS, type GroupName } from './fields.ts';

export function saveTemplate(group: GroupName): void {
  const rows = [0, 1].map((row) => FIELDS[group].map(({ examples }) => examples[row]));
  const lines = [FIELDS[group].map(({ name }) => name), ...rows].map((row) => `${row.join(',')}\n`);
  download(lines.join(''), fileName(['template', group], 'csv'));
}
