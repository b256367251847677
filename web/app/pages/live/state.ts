/** State of the live page: what is shown and how. Ports, sockets and what comes over them are nobody's to link to. */
import { signal } from '@preact/signals';
import type { ChainOptions, Method } from 'boresight';
import { COLOR_MAPS } from '../../../plots/colormap.ts';
import { optionsOf } from '../../options.ts';
import type { Caption } from '../../state/address.ts';
import { choice, codec, number } from '../../state/codec.ts';
import { COLOURED_BY } from '../../ui/space/points.ts';

const detection = optionsOf('DetectionOptions');

/** Estimators that a frame is done with before the next one is there. */
export const QUICK: readonly Method[] = ['bartlett', 'capon', 'iaa', 'music', 'root-music', 'esprit', 'nomp'];

export const liveCodec = codec(
  {
    /** A board's own detections over its serial port, or raw samples over the bridge. */
    source: choice('board', ['board', 'raw']),
    /** What begins by itself. */
    play: choice('nothing', ['nothing', 'bundled']),
    pace: choice('recorded', ['recorded', 'port', 'ten', 'fast']),
    commandBaud: number(115_200, [300, 8_000_000], 'integer'),
    dataBaud: number(921_600, [300, 8_000_000], 'integer'),
    bridge: number(8417, [1, 65_535], 'integer'),
    keep: choice('minute', ['minute', 'all']),
    range: number(0, [0, 1000]),
    falseAlarm: detection.picks('cfar.falseAlarm', ['1e-2', '1e-3', '1e-4', '1e-5', '1e-6', '1e-7', '1e-8']),
    clutter: detection.field('staticClutterRemoval'),
    angle: detection.field('angle.method'),
    span: choice('60', ['30', '40', '50', '60', '80']),
    colors: choice('viridis', COLOR_MAPS),
    /** The board's detections from above, or in space. */
    points: choice('above', ['above', 'space']),
    pointColour: choice('rate', COLOURED_BY),
  },
  ['source'],
);

export type LiveState = typeof liveCodec.defaults;
export const liveState = signal<LiveState>(liveCodec.defaults);

export function update(patch: Partial<LiveState>): void {
  liveState.value = { ...liveState.value, ...patch };
}

/** How raw frames are processed, as the package takes it. */
export const chainOptions = ({ falseAlarm, clutter, angle }: LiveState): ChainOptions => ({
  staticClutterRemoval: clutter,
  cfar: { falseAlarm: Number(falseAlarm) },
  angle: { method: angle },
});

export const bridgeAddress = ({ bridge }: LiveState): string => `ws://127.0.0.1:${bridge}`;

export const captionOf = (state: LiveState, data: string): Caption => ({
  data,
  settings:
    state.source === 'board'
      ? 'detections of the board itself'
      : `false alarms ${state.falseAlarm}, angles by ${state.angle}`,
});
