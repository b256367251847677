/** Where the drive comes from. */

import { byteSize } from '../../../../plots/format.ts';
import { showHelp } from '../../../state/settings.ts';
import { useFileDrop } from '../../../ui/drop.ts';
import { FileButton } from '../../../ui/file-button.tsx';
import { Licence } from '../../../ui/licence.tsx';
import { SeedField } from '../../../ui/seed-field.tsx';
import { Control } from '../control.ts';
import { Live } from '../live/panel.tsx';
import { mountingState, update } from '../state.ts';
import { chooseSource, driveProblem, loaded, shownFiles } from './drive.ts';
import { changeColumns, openFiles, tables } from './own-files.ts';
import { Topics } from './topics.tsx';

export function Source() {
  const over = useFileDrop('mounting', (files) => void openFiles(files));
  const state = mountingState.value;
  const open = loaded.value;
  const { files, licence } = shownFiles.value;
  return (
    <>
      <Control
        label="Drive"
        name="source"
        only={['delphi', 'simulated', 'live']}
        labels={{ delphi: 'bundled', live: 'live server', files: 'own files' }}
        help="The bundled drive is a car's front radar in traffic; a simulated one has a truth to compare with; a live server on this machine sends a drive as it goes on."
        onChange={(source) => {
          if (source !== 'files') chooseSource(source);
        }}
      />
      {state.source === 'simulated' && <Simulation />}
      {state.source === 'live' && <Live part="Source" />}
      <div class={`drop${over.value ? ' over' : ''}`}>
        {files.length > 0 && (
          <ul class="files own" aria-label="Open files">
            {files.slice(0, 6).map(({ name, bytes }) => (
              <li key={name}>
                <span class="file">{name}</span>
                <span class="muted">{bytes === undefined ? '' : byteSize(bytes)}</span>
              </li>
            ))}
            {files.length > 6 && <li class="muted">and {files.length - 6} more</li>}
          </ul>
        )}
        {licence && (
          <Licence
            address={licence}
            summary="From PJLab-ADG/SensorsCalibration, Apache-2.0"
            remark="The first 600 s of its drive with a Delphi (Aptiv) ESR. These are tracked objects at 20 Hz, not raw detections; the yaw rate is differentiated from the pose."
          />
        )}
        {open && <Topics drive={open.drive} />}
        <div class="row">
          <FileButton
            label="Drive files"
            accept=".csv,.gz,.h5,.hdf5,.mcap,.pcd,.bin,.json"
            multiple
            name="drive-files"
            title="Tables (.csv, .csv.gz) of detections and motion, radar_data.h5, a recording of ROS 2 (.mcap), or point clouds (.pcd) with their tables"
            onFiles={(files) => void openFiles(files)}
          >
            Open files
          </FileButton>
          <FileButton
            label="Drive folder"
            folder
            name="drive-folder"
            title="The folder of a RadarScenes sequence, of point clouds, or of tables"
            onFiles={(files) => void openFiles(files)}
          >
            Open a folder
          </FileButton>
          {tables.value.length > 0 && (driveProblem.value || open?.source === 'files') && (
            <button
              type="button"
              data-action="columns"
              onClick={() => void changeColumns()}
              title="Say what the columns of your tables hold, with their units and signs"
            >
              Columns
            </button>
          )}
        </div>
        <p class={showHelp.value ? 'help' : 'muted small'}>
          Or drop a recording of ROS 2 (.mcap), the folder of a RadarScenes sequence, radar clouds of nuScenes or
          TruckScenes, frames of View-of-Delft, Delphi tables or CSV tables of any columns anywhere on the page. Nothing
          is uploaded.
        </p>
      </div>
    </>
  );
}

function Simulation() {
  return (
    <>
      <Control label="Scenario" name="scenario" />
      <Control label="Errors" name="profile" />
      <Control label="Duration" name="duration" />
      <Control label="Moving share" name="moving" />
      <Control
        label="Misalignment"
        name="misalignment"
        step={0.1}
        help="By how much the true mounting angle of each radar exceeds its nominal one."
      />
      <SeedField
        value={mountingState.value.seed}
        what="drive"
        title="Another drive of the kind"
        onChange={(seed) => update({ seed })}
      />
    </>
  );
}
