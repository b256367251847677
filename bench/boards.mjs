// A board's bytes: how much faster they are read than its port sends them.
import { readFileSync } from 'node:fs';
import { compare } from './measure.mjs';

const recording = (name) => readFileSync(new URL(`../recordings/awr1642/${name}`, import.meta.url));
/** 921600 bits a second, ten bits a byte. */
const PORT_BYTES_PER_S = 92_160;
/** As a serial port hands them on. */
const PIECE = 509;

export async function boardRow({ row, pace, boresight }) {
  const name = `a board's bytes, ${PIECE} at a time: beside the speed of its port`;
  await row(name, { unit: 'x', otherName: 'the port', target: { least: 50 } }, async () => {
    const [dat, cfg] = [recording('xwr16xx_crw_demo_visualizer_2018_1015v2.dat'), recording('profile.cfg')];
    const pieces = [];
    for (let at = 0; at < dat.length; at += PIECE) pieces.push(Uint8Array.from(dat.subarray(at, at + PIECE)));
    async function* source() {
      yield* pieces;
    }
    const side = async (calls) => {
      const start = process.hrtime.bigint();
      for (let call = 0; call < calls; call++) {
        const frames = boresight.boardFrames(source(), cfg);
        for await (const _ of frames);
        if (frames.counts.frames !== 250) throw new Error(`${frames.counts.frames} frames are not 250`);
      }
      return Number(process.hrtime.bigint() - start) / 1e9;
    };
    const [{ seconds }] = await compare([side], pace);
    const portS = dat.length / PORT_BYTES_PER_S;
    const ratio = { median: portS / seconds.median, low: portS / seconds.high, high: portS / seconds.low };
    return { ours: seconds, other: { median: portS, low: portS, high: portS }, ratio, value: ratio.median };
  });
}
