/** Scene, radars, methods and how the images are shown. */
import type { Method } from 'boresight';
import { singleSnapshotMethods } from '../../methods.ts';
import { choosing, fitting } from '../../networks/choose.ts';
import { stopped } from '../../networks/load.ts';
import { COLOR_MAPS } from '../../plots/colormap.ts';
import { showHelp } from '../../state/settings.ts';
import { CheckField, Group, SelectField, SliderField } from '../../ui/field.tsx';
import { MethodList } from '../../ui/method-list.tsx';
import { NetworkNote } from '../../ui/network-note.tsx';
import { NumberField } from '../../ui/number-field.tsx';
import { Sidebar } from '../../ui/sidebar.tsx';
import { cellM, input, reachM } from './input.ts';
import { geometriesOf, images, networkFor, unavailable } from './process.ts';
import { birdseyeState, CELLS, FALSE_ALARMS, LIMITS, RADARS, restoreDefaults, SPANS, update } from './state.ts';

export function Controls() {
  const state = birdseyeState.value;
  const street = state.source === 'street';
  return (
    <Sidebar label="Bird’s-eye view settings" button="scene and settings">
      <div class="controls-head">
        <CheckField
          label="Explain the controls"
          value={showHelp.value}
          help="Shows a sentence below each control."
          onChange={(on) => {
            showHelp.value = on;
          }}
        />
        <button
          type="button"
          class="plain"
          title="Back to the settings a fresh visit starts with"
          onClick={restoreDefaults}
        >
          Defaults
        </button>
      </div>
      <Group title="Scene">
        <SelectField
          label="Input"
          name="source"
          value={state.source}
          options={[
            ['street', 'simulated street'],
            ['capture', 'real capture'],
          ]}
          help="A street that four radars of a car see, with its truth; or the recording that is open on the page Capture."
          onChange={(source) => update({ source })}
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
        <SelectField
          label="Images of"
          name="from"
          value={state.from}
          options={[
            ['spectra', 'spectra'],
            ['targets', 'targets'],
          ]}
          help="What each cell adds to the image: its whole spectrum over azimuth, or the directions found in it. Methods without a spectrum give targets."
          onChange={(from) => update({ from })}
        />
        <SelectField
          label="Spectrum"
          name="points"
          value={state.points}
          options={(['256', '512', '1024', '2048'] as const).map((points) => [points, `${points} points`] as const)}
          help="Points of each cell's spectrum, uniform in the sine of azimuth."
          onChange={(points) => update({ points })}
        />
        <SelectField
          label="Sources a cell"
          name="sources"
          value={state.sources}
          options={(['1', '2', '3', '4'] as const).map((sources) => [sources, sources] as const)}
          help="Directions that maximum likelihood and MUSIC look for in each cell: one snapshot does not tell how many there are. The others need not know."
          onChange={(sources) => update({ sources })}
        />
        <CheckField
          label="Refine by Gauss-Newton"
          name="refine"
          value={state.refine}
          help="Fits all angles of a method together to each cell: drops those that noise explains, adds what was missed. Of images of targets."
          onChange={(refine) => update({ refine })}
        />
        <SelectField
          label="False-alarm rate"
          name="falseAlarm"
          value={state.falseAlarm}
          options={FALSE_ALARMS.map(
            (rate) =>
              [
                rate,
                `10${rate
                  .slice(2)
                  .replace('-', '⁻')
                  .replace(/\d/, (digit) => '⁰¹²³⁴⁵⁶⁷⁸⁹'[Number(digit)] ?? '')}`,
              ] as const,
          )}
          help="Of the detector: probability that noise alone passes in one cell of range and Doppler. A higher one detects more cells."
          onChange={(falseAlarm) => update({ falseAlarm })}
        />
        <CheckField
          label="Keep local peaks only"
          name="grouping"
          value={state.grouping}
          help="Of adjacent cells over the threshold, the strongest alone goes into the image: faster, and less is filled."
          onChange={(grouping) => update({ grouping })}
        />
      </Group>
      <Group title="Image">
        <NumberField
          label="Reach"
          unit="m"
          name="reach"
          value={reachM.value}
          min={LIMITS.reachM[0]}
          max={LIMITS.reachM[1]}
          step={5}
          help="How far the images go ahead of the rear axle; to each side it is less."
          onChange={(reach) => update({ reach })}
        />
        <SelectField
          label="Cell"
          name="cell"
          value={String(cellM.value) as '0.2'}
          options={CELLS.map((size) => [size, `${size} m`] as const)}
          help="Width of a cell of the image."
          onChange={(cell) => update({ cell })}
        />
        {street && (
          <NumberField
            label="Gate"
            unit="m"
            name="gate"
            value={state.gate ?? Number.NaN}
            min={LIMITS.gateM[0]}
            max={LIMITS.gateM[1]}
            step={0.5}
            help="The sidelobe measure counts what is farther than this from every true point. Empty for as much as the radars cannot resolve, which grows with range."
            onChange={(gate) => update({ gate })}
            onEmpty={() => update({ gate: null })}
          />
        )}
      </Group>
      <Group title="Display">
        <SelectField
          label="Dynamic range"
          name="span"
          value={state.span}
          options={SPANS.map((span) => [span, `${span} dB`] as const)}
          help="From the first colour to the last."
          onChange={(span) => update({ span })}
        />
        <NumberField
          label="Last colour"
          unit="dBFS"
          name="top"
          value={state.top ?? Number.NaN}
          min={LIMITS.topDb[0]}
          max={LIMITS.topDb[1]}
          step={1}
          help="Power of the last colour; the same for all images. Empty for the strongest cell of all."
          onChange={(top) => update({ top })}
          onEmpty={() => update({ top: null })}
        />
        <SelectField
          label="Colour map"
          name="colors"
          value={state.colors}
          options={COLOR_MAPS.map((name) => [name, name] as const)}
          help="All three are perceptually uniform; cividis is made for colour-blind readers."
          onChange={(colors) => update({ colors })}
        />
        <SliderField
          label="Opacity"
          name="opacity"
          value={state.opacity}
          min={LIMITS.opacity[0]}
          max={LIMITS.opacity[1]}
          step={5}
          text={`${state.opacity} %`}
          help="Of the image over the grid of the plot."
          onChange={(opacity) => update({ opacity })}
        />
        <CheckField
          label={street ? 'Truth' : 'Objects the board reported'}
          name="truth"
          value={state.truth}
          help="Draws the things of the street and their points over the images; for the capture what its board reported."
          onChange={(truth) => update({ truth })}
        />
        <CheckField
          label="Fields of view"
          name="fields"
          value={state.fields}
          help="Draws where each radar sits and what it sees."
          onChange={(fields) => update({ fields })}
        />
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
  const state = birdseyeState.value;
  return (
    <>
      <NumberField
        label="Own speed"
        unit="m/s"
        name="speed"
        value={state.speed}
        min={LIMITS.speedMps[0]}
        max={LIMITS.speedMps[1]}
        step={1}
        help="The faster the car, the farther Doppler tells apart what stands at one range in different directions."
        onChange={(speed) => update({ speed })}
      />
      <NumberField
        label="Seed"
        name="seed"
        integer
        value={state.seed}
        min={LIMITS.seed[0]}
        max={LIMITS.seed[1]}
        help="Everything random comes from it: the same seed gives the same street."
        onChange={(seed) => update({ seed })}
      />
      <button
        type="button"
        class="plain new-seed"
        title="Another street"
        onClick={() => update({ seed: (state.seed + 1) % LIMITS.seed[1] })}
      >
        Next seed
      </button>
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
