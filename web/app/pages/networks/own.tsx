/** A network of one's own: an ONNX file, with its card or without. */

import { signal } from '@preact/signals';
import { byteSize } from '../../../plots/format.ts';
import { describeError, FileProblem, type Problem } from '../../data.ts';
import { addModel, ownModels } from '../../networks/load.ts';
import { showHelp } from '../../state/settings.ts';
import { useFileDrop } from '../../ui/drop.ts';
import { FileButton } from '../../ui/file-button.tsx';
import { update } from './state.ts';

export const ownProblem = signal<(Problem & { file: string }) | null>(null);
const reading = signal(false);

/** More than any network this page could run in useful time. */
const LARGEST_BYTES = 256 * 1024 * 1024;

const ending = (file: File): string => file.name.toLowerCase().split('.').pop() ?? '';

async function open(files: readonly File[]): Promise<void> {
  const onnx = files.find((file) => ending(file) !== 'json');
  const card = files.find((file) => ending(file) === 'json');
  if (!files.length) return;
  const blame = onnx ?? card;
  reading.value = true;
  try {
    if (!onnx) throw new FileProblem('missing', card?.name ?? '', 'the ONNX file of this card is needed beside it');
    if (files.length > (card ? 2 : 1))
      throw new FileProblem('ambiguous', onnx.name, 'one ONNX file, with its card or without, is expected');
    if (onnx.size > LARGEST_BYTES)
      throw new FileProblem(
        'too-large',
        onnx.name,
        `${byteSize(onnx.size)}; at most ${byteSize(LARGEST_BYTES)} are expected`,
      );
    const model = await addModel(onnx.name, new Uint8Array(await onnx.arrayBuffer()), await card?.text());
    ownProblem.value = null;
    update({ model: model.name });
  } catch (error) {
    ownProblem.value =
      error instanceof FileProblem
        ? { code: error.code, message: error.message, file: error.file }
        : { ...describeError(error), file: blame?.name ?? '' };
  } finally {
    reading.value = false;
  }
}

export function OwnNetwork() {
  const over = useFileDrop('networks', (files) => void open(files.map(({ file }) => file)));
  return (
    <div class={`drop${over.value ? ' over' : ''}`}>
      {ownModels.value.length > 0 && (
        <ul class="files own" aria-label="Own networks">
          {ownModels.value.map(({ name, card }) => (
            <li key={name}>
              <span class="file">{name.slice(4)}</span>
              <span class="muted">{byteSize(card.bytes ?? 0)}</span>
            </li>
          ))}
        </ul>
      )}
      <div class="row">
        <FileButton
          label="ONNX file"
          accept=".onnx,.json"
          multiple
          name="onnx"
          title="An .onnx file, and its card (.json) if there is one"
          disabled={reading.value}
          onFiles={(files) => void open(files.map(({ file }) => file))}
        >
          {reading.value ? 'Reading' : 'Open ONNX file'}
        </FileButton>
      </div>
      <p class={showHelp.value ? 'help' : 'muted small'}>
        Or drop an .onnx, with its card or without, anywhere on the page. Its inputs and outputs must be those of one of
        the networks here. Nothing is uploaded.
      </p>
    </div>
  );
}
