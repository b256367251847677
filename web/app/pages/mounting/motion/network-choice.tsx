/** Whose weights motions by a network go by. */

import { byteSize } from '../../../../plots/format.ts';
import { FileButton } from '../../../ui/file-button.tsx';
import { Notice } from '../../../ui/notice.tsx';
import { mountingState } from '../state.ts';
import { needsNetwork, networkProblem, openNetwork, ownNetwork } from './motion-network.ts';

export function NetworkChoice() {
  if (!needsNetwork(mountingState.value.motion)) return null;
  const own = ownNetwork.value;
  const problem = networkProblem.value;
  return (
    <div class="network-choice">
      <p class="small">
        {own
          ? `Weights of ${own.name}, ${byteSize(own.bytes.length)}.`
          : 'A network that was trained on simulated drives weighs the detections. The recursive methods take its weights and find the motion themselves.'}
      </p>
      <p class="muted small">
        {mountingState.value.motion === 'deepego-plus'
          ? 'Over whole simulated drives DeepEgo+ errs more than DeepEgo, ahead in dense traffic by far: what is wrong lasts longer than eight frames.'
          : 'On real radars that look aside DeepEgo’s frames are no better than RANSAC’s; it gains where much moves.'}{' '}
        The recursive method alone is as good or better on nearly all drives.
      </p>
      <div class="row">
        <FileButton
          label="Weights of a network of motion"
          accept=".bin"
          name="motion-network"
          title="A .bin file that the training exported"
          onFiles={([first]) => first && void openNetwork(first.file)}
        >
          Open weights
        </FileButton>
        {own && (
          <button type="button" onClick={() => (ownNetwork.value = null)}>
            Use those of the package
          </button>
        )}
      </div>
      {problem && (
        <Notice name="motion-network" onClose={() => (networkProblem.value = null)}>
          {problem.file}: {problem.message}
        </Notice>
      )}
    </div>
  );
}
