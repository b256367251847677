/** Scene, radars, methods and how the images are shown. */
import type { Method } from 'boresight';
import { power } from '../../../plots/format.ts';
import { singleSnapshotMethods } from '../../methods.ts';
import { choosing, fitting } from '../../networks/choose.ts';
import { stopped } from '../../networks/load.ts';
import { controlOf } from '../../ui/control.tsx';
import { ControlsHead } from '../../ui/controls-head.tsx';
import { CheckField, Group, SliderField } from '../../ui/field.tsx';
import { MethodList } from '../../ui/method-list.tsx';
import { NetworkNote } from '../../ui/network-note.tsx';
import { SeedField } from '../../ui/seed-field.tsx';
import { Sidebar } from '../../ui/sidebar.tsx';
import { cellM, input, reachM } from './input.ts';
import { geometriesOf, images, networkFor, unavailable } from './process.ts';
import { birdseyeCodec, birdseyeState, RADARS, restoreDefaults, update } from './state.ts';

const Control = controlOf(birdseyeCodec, birdseyeState, update);

export function Controls() {
  const state = birdseyeState.value;
  const street = state.source === 'street';
  return (
    <Sidebar label="Bird’s-eye view settings" button="scene and settings">
      <ControlsHead code={async () => (await import('./code.ts')).birdseyeCode} onDefaults={restoreDefaults} />
      <Group title="Scene">
        <Control
          label="Input"
          name="source"
          labels={{ street: 'simulated street', capture: 'real capture' }}
          help="A street that four radars of a car see, with its truth; or the recording that is open on the page Capture."
        />
        {street ? <Street /> : <Frame />}
      </Group>
      {street && (
        <Group title="Radars">
          {RADARS.map((name) => (
            <CheckField
              key={name}
              label={name.replace('-', ' ')}
              name={`radar-${name}`}
              value={state.radars.includes(name)}
              help="Switches this radar on or off. Where several see a place, the strongest is shown."
              onChange={(on) =>
                update({ radars: RADARS.filter((other) => (other === name ? on : state.radars.includes(other))) })
              }
            />
          ))}
        </Group>
      )}
      <Group title="Methods">
        <MethodList
          label="Methods"
          prefix="method"
          chosen={state.methods}
          onChange={(methods) => update({ methods })}
          items={singleSnapshotMethods().map((info) => ({
            name: info.name,
            title: info.title,
            about: `${info.reference}. Cost: ${info.cost}.`,
            line: info.spectrum,
            off: unavailable.value.get(info.name),
            note:
              info.network && stopped(networkFor(info.name)?.name)
                ? undefined
                : images.value.get(info.name)?.problem?.message,
            detail: info.network && <Network method={info.name} />,
          }))}
        />
        <Control
          label="Images of"
          name="from"
          help="What each cell adds to the image: its whole spectrum over azimuth, or the directions found in it. Methods without a spectrum give targets."
        />
        <Control label="Spectrum" name="points" labels={(points) => `${points} points`} />
        <Control
          label="Sources a cell"
          name="sources"
          help="Directions that maximum likelihood and MUSIC look for in each cell: one snapshot does not tell how many there are. The others need not know."
        />
        <Control label="Refine by Gauss-Newton" name="refine" note="Of images of targets." />
        <Control label="False-alarm rate" name="falseAlarm" labels={power} note="A higher one detects more cells." />
        <Control
          label="Keep local peaks only"
          name="grouping"
          help="Of adjacent cells over the threshold, the strongest alone goes into the image: faster, and less is filled."
        />
      </Group>
      <Group title="Image">
        <Control
          label="Reach"
          name="reach"
          unit="m"
          value={reachM.value}
          step={5}
          help="How far the images go ahead of the rear axle; to each side it is less. Empty for what suits the scene."
        />
        <Control
          label="Cell"
          name="cell"
          value={String(cellM.value) as '0.2'}
          labels={(size) => `${size} m`}
          help="Width of a cell of the image."
        />
        {street && (
          <Control
            label="Gate"
            name="gate"
            unit="m"
            step={0.5}
            help="The sidelobe measure counts what is farther than this from every true point. Empty for as much as the radars cannot resolve, which grows with range."
          />
        )}
      </Group>
      <Group title="Display">
        <Control
          label="Dynamic range"
          name="span"
          labels={(span) => `${span} dB`}
          help="From the first colour to the last."
        />
        <Control
          label="Last colour"
          name="top"
          unit="dBFS"
          help="Power of the last colour; the same for all images. Empty for the strongest cell of all."
        />
        <Control
          label="Colour map"
          name="colors"
          help="All three are perceptually uniform; cividis is made for colour-blind readers."
        />
        <SliderField
          label="Opacity"
          name="opacity"
          value={state.opacity}
          {...birdseyeCodec.fields.opacity.range}
          step={5}
          text={`${state.opacity} %`}
          help="Of the image over the grid of the plot."
          onChange={(opacity) => update({ opacity })}
        />
        <Control
          label={street ? 'Truth' : 'Objects the board reported'}
          name="truth"
          help="Draws the things of the street and their points over the images; for the capture what its board reported."
        />
        <Control label="Fields of view" name="fields" help="Draws where each radar sits and what it sees." />
      </Group>
    </Sidebar>
  );
}

function Network({ method }: { method: Method }) {
  const model = networkFor(method);
  if (!model) return null;
  const { methods, networks } = birdseyeState.value;
  return (
    <NetworkNote
      model={model}
      choices={fitting(method, geometriesOf(input.value?.radars ?? []), null)}
      chosen={methods.includes(method)}
      onChange={(next) => update({ networks: choosing(networks, next) })}
    />
  );
}

function Street() {
  return (
    <>
      <Control label="Own speed" name="speed" />
      <SeedField
        value={birdseyeState.value.seed}
        what="street"
        title="Another street"
        onChange={(seed) => update({ seed })}
      />
    </>
  );
}

function Frame() {
  const frames = input.value?.capture?.info.frames ?? 1;
  const frame = Math.min(birdseyeState.value.frame, frames - 1);
  return (
    <SliderField
      label="Frame"
      name="frame"
      value={frame}
      min={0}
      max={frames - 1}
      step={1}
      text={`${frame + 1} of ${frames}`}
      disabled={frames < 2}
      help="The frame of the capture that is shown."
      onChange={(next) => update({ frame: next })}
    />
  );
}
