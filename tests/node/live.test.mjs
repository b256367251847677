// Boards live: the recorded bytes of a board through ports that a test feeds.
import assert from 'node:assert/strict';
import { before, describe, test } from 'node:test';
import { boardFrames, init, parseBoardLog, RecentBytes, replayBytes, sendConfiguration, serialBytes } from 'boresight';
import { fakeSerial, feedRecording } from '../lib/fake-serial.mjs';
import { rejectsTyped, throwsTyped } from './lib/assert.mjs';
import { cfg, dat } from './lib/recording.mjs';

const FakePort = fakeSerial();
const bytes = Uint8Array.from(dat);
/** Where packets begin, by their magic word. */
const starts = [];
for (let at = dat.indexOf('0201040306050807', 'hex'); at >= 0; at = dat.indexOf('0201040306050807', at + 1, 'hex'))
  starts.push(at);
/** A byte in the middle of the payload of packet `k`. */
const inPacket = (k) => starts[k] + 300;

let recorded;
before(async () => {
  await init();
  recorded = parseBoardLog(bytes, cfg);
});

/** All of a source, until it ends or `enough` says so. */
async function collect(source, enough = () => false) {
  const all = [];
  for await (const one of source) {
    all.push(one);
    if (enough(all)) break;
  }
  return all;
}

/** Frames of a port until the recording's last is held back, and those then. */
async function framesOf(port, run = () => {}, options = {}) {
  const ending = new AbortController();
  const states = [];
  const source = serialBytes(port, {
    ...options,
    signal: ending.signal,
    onChange: ({ state }) => states.at(-1) !== state && states.push(state),
  });
  const frames = boardFrames(source, cfg);
  const all = [];
  const done = (async () => {
    for await (const frame of frames) all.push(frame);
  })();
  await run({ all, source, frames });
  await until(() => source.state === 'ended' || all.at(-1)?.frameNumber === 710);
  ending.abort();
  await done;
  return { all, source, counts: frames.counts, states };
}

async function until(check) {
  for (let tries = 0; !check(); tries++) {
    assert.ok(tries < 2000, 'what was waited for came');
    await new Promise((resolve) => setTimeout(resolve, 5));
  }
}

describe('a data port', () => {
  test('gives the frames and counts of the recording', async () => {
    for (const piece of [1, 509, 4096, 200_000]) {
      const port = new FakePort();
      feedRecording(port, piece === 1 ? bytes.subarray(0, 20_000) : bytes, { piece });
      if (piece === 1) feedRecording(port, bytes.subarray(20_000));
      const { all, counts, source } = await framesOf(port);
      assert.deepEqual(all, recorded.frames, `${piece} bytes at a time`);
      const { skippedBytes, damagedPackets, warnings } = recorded;
      assert.deepEqual(counts, {
        ...{ bytes: bytes.length, frames: 250, missedFrames: 0, restarts: 0 },
        ...{ skippedBytes, damagedPackets, warnings },
      });
      assert.equal(source.counts.bytes, bytes.length);
      assert.deepEqual(port.opened, [{ baudRate: 921_600, bufferSize: 262_144 }]);
      assert.equal(port.closed, 1);
    }
  });

  test('goes on after errors of the line, and each is counted', async () => {
    const port = new FakePort();
    const errors = [
      { at: inPacket(3), name: 'FramingError', lost: 1 },
      { at: inPacket(50), name: 'FramingError', lost: 17 },
      { at: inPacket(51), name: 'BreakError', lost: 2 },
      { at: inPacket(90), name: 'ParityError', lost: 1 },
      // Two packets lose bytes, and the one between them all.
      { at: inPacket(120), name: 'BufferOverrunError', lost: inPacket(122) - inPacket(120) + 5 },
      { at: inPacket(200), name: 'UnknownError', lost: 1 },
    ];
    feedRecording(port, bytes, { errors });
    const { all, counts, source } = await framesOf(port);
    const { bytes: arrived, ...line } = source.counts;
    assert.deepEqual(line, {
      framingErrors: 2,
      breaks: 1,
      parityErrors: 1,
      overruns: 1,
      otherErrors: 1,
      losses: 0,
    });
    assert.equal(arrived, bytes.length - errors.reduce((sum, { lost }) => sum + lost, 0));
    const whole = all.filter(({ complete }) => complete);
    // Of the three that the overrun met one header came. The recording ends inside its last packet.
    assert.equal(counts.damagedPackets, errors.length + 1);
    assert.equal(counts.missedFrames, errors.length + 2);
    assert.equal(whole.length + counts.damagedPackets + 2, 250);
    for (const frame of all) {
      const same = recorded.frames.find(({ frameNumber }) => frameNumber === frame.frameNumber);
      assert.deepEqual(frame, same);
    }
  });

  test('loses no packet to errors that cost no byte', async () => {
    const port = new FakePort();
    const errors = [10, 20, 30].map((k) => ({ at: inPacket(k), name: 'FramingError' }));
    feedRecording(port, bytes, { errors });
    const { all, counts } = await framesOf(port);
    assert.deepEqual(all, recorded.frames);
    assert.equal(counts.damagedPackets, recorded.damagedPackets);
  });

  test('is waited for while it is unplugged', async () => {
    const port = new FakePort();
    feedRecording(port, bytes.subarray(0, inPacket(100)));
    const { all, counts, source, states } = await framesOf(port, async ({ source }) => {
      port.unplug();
      await until(() => source.state === 'lost');
      assert.equal(port.readable, null);
      port.plug();
      await until(() => source.state === 'open');
      feedRecording(port, bytes.subarray(inPacket(102)));
    });
    assert.deepEqual(states, ['open', 'lost', 'open', 'ended']);
    assert.equal(source.counts.losses, 1);
    assert.equal(port.opened.length, 2);
    // Packets 100 and 102 were cut, 101 never came.
    assert.equal(counts.missedFrames, 3);
    assert.equal(all.length, 250 - 3);
  });

  test('is changed for another while it is open and while it is gone', async () => {
    for (const gone of [false, true]) {
      const [first, second] = [new FakePort(), new FakePort()];
      feedRecording(first, bytes.subarray(0, starts[120]));
      const { all, states } = await framesOf(first, async ({ all, source }) => {
        await until(() => all.length === 120);
        if (gone) {
          first.unplug();
          await until(() => source.state === 'lost');
        }
        feedRecording(second, bytes.subarray(starts[120]));
        source.usePort(second);
      });
      assert.deepEqual(all, recorded.frames);
      assert.deepEqual(states, gone ? ['open', 'lost', 'open', 'ended'] : ['open', 'ended']);
      assert.equal(first.closed, 1);
      assert.equal(second.closed, 1);
    }
  });

  test('that cannot be read says why', async () => {
    const absent = new FakePort();
    absent.plugged = false;
    await rejectsTyped(collect(serialBytes(absent)), 'port-not-opened', 'the serial port');
    const port = new FakePort();
    port.feed(Uint8Array.of(1));
    const leaving = collect(serialBytes(port, { reconnect: false }), () => void port.unplug());
    await rejectsTyped(leaving, 'port-lost', 'the serial port');
    const noisy = new FakePort();
    for (let k = 0; k < 1100; k++) noisy.fail('FramingError');
    await rejectsTyped(collect(serialBytes(noisy)), 'port-failing', 'the serial port');
    assert.equal(noisy.closed, 1);
    const source = serialBytes(new FakePort());
    const first = source[Symbol.asyncIterator]().next();
    await rejectsTyped(collect(source), 'port-in-use');
    first.catch(() => {});
    throwsTyped(() => serialBytes(port, { bufferSize: 4096 }), 'out-of-range', 'bufferSize');
    throwsTyped(() => serialBytes(port, { baudRate: 0 }), 'out-of-range', 'baudRate');
  });

  test('that its page had opened stays open', async () => {
    const port = new FakePort();
    await port.open({ baudRate: 57_600 });
    feedRecording(port, bytes);
    const [first] = await collect(serialBytes(port), (all) => all.length === 1);
    assert.equal(first.length, 509);
    assert.equal(port.closed, 0);
    assert.equal(port.readable.locked, false);
  });
});

describe('frames', () => {
  test('that were passed over and restarts are counted', async () => {
    const packet = (k) => bytes.slice(starts[k], starts[k + 1]);
    const given = [0, 1, 5, 6, 2, 3, 9].map(packet);
    const frames = boardFrames(
      (async function* () {
        yield* given;
      })(),
    );
    assert.equal((await collect(frames)).length, 7);
    assert.equal(frames.counts.missedFrames, 3 + 5);
    assert.equal(frames.counts.restarts, 1);
  });

  test('end with what they come from, and say its errors', async () => {
    const failing = boardFrames(
      (async function* () {
        yield bytes.slice(0, inPacket(13));
        throw new RangeError('no more');
      })(),
    );
    await assert.rejects(collect(failing), RangeError);
    assert.equal(failing.counts.frames, 13);
    await rejectsTyped(collect(boardFrames([bytes], 'sensorStart')), 'config-incomplete');
  });
});

describe('a replay', () => {
  test('gives the bytes of a file, and the frames of the recording', async () => {
    for (const data of [bytes, bytes.slice().buffer, new Blob([bytes])]) {
      const pieces = await collect(replayBytes(data, { rate: Number.POSITIVE_INFINITY, pieceBytes: 1000 }));
      assert.deepEqual(new Uint8Array(Buffer.concat(pieces)), bytes);
      assert.ok(pieces.every(({ length }) => length <= 1000));
    }
    const frames = await collect(boardFrames(replayBytes(bytes, { rate: Number.POSITIVE_INFINITY }), cfg));
    assert.deepEqual(frames, recorded.frames);
  });

  test('is no faster than it should be', async () => {
    const begun = performance.now();
    const pieces = await collect(replayBytes(bytes, { rate: 10 }));
    assert.ok(performance.now() - begun >= (1000 * bytes.length) / 921_600 - 1);
    assert.equal(Buffer.concat(pieces).length, bytes.length);
  });

  test('ends when it is told to, and refuses what is none', async () => {
    const ending = new AbortController();
    const pieces = await collect(replayBytes(bytes, { signal: ending.signal }), () => {
      ending.abort();
      return false;
    });
    assert.equal(pieces.length, 1);
    assert.deepEqual(await collect(replayBytes(new Uint8Array())), []);
    throwsTyped(() => replayBytes('text'), 'wrong-type', 'recording');
    throwsTyped(() => replayBytes(bytes, { rate: 0 }), 'out-of-range', 'rate');
    throwsTyped(() => replayBytes(bytes, { bytesPerSecond: Number.NaN }), 'out-of-range', 'bytesPerSecond');
  });
});

describe('recent bytes', () => {
  const piece = (first) => Uint8Array.of(first, first + 1);

  test('are bounded by age, and what is forgotten is counted', () => {
    const recent = new RecentBytes({ seconds: 2 });
    for (let k = 0; k < 10; k++) recent.push(piece(2 * k), 500 * k);
    assert.deepEqual([...recent.bytes()], [10, 11, 12, 13, 14, 15, 16, 17, 18, 19]);
    assert.deepEqual(recent.counts, { bytes: 10, seconds: 2, forgottenBytes: 10 });
  });

  test('are bounded by amount', () => {
    const recent = new RecentBytes({ bytes: 5 });
    for (let k = 0; k < 1000; k++) recent.push(piece(k % 200), 0);
    assert.deepEqual(recent.counts, { bytes: 4, seconds: 0, forgottenBytes: 1996 });
    recent.push(Uint8Array.of(1, 2, 3, 4, 5, 6, 7), 0);
    assert.deepEqual([...recent.bytes()], [3, 4, 5, 6, 7]);
    assert.equal(recent.counts.forgottenBytes, 2000 + 2);
    throwsTyped(() => new RecentBytes({ seconds: 0 }), 'out-of-range', 'seconds');
  });

  test('are those that went by, as they were then', async () => {
    const recent = new RecentBytes();
    const mine = Uint8Array.of(1, 2, 3);
    for await (const bytes of recent.of([mine])) bytes.fill(0);
    assert.deepEqual([...recent.bytes()], [1, 2, 3]);
  });
});

describe('a configuration', () => {
  const lines = cfg
    .toString()
    .split(/\r?\n/)
    .map((line) => line.split('%')[0].trim())
    .filter(Boolean);

  test('is sent a line after the answer to the one before', async () => {
    const port = new FakePort(() => 'Done');
    // A prompt and a message of before are no answer.
    port.feed('Error: of the last session\r\nmmwDemo:/>');
    const sent = [];
    await sendConfiguration(port, `\ufeff${cfg.toString().replaceAll('\n', '\r\n')}`, {
      onLine: (line) => sent.push(line),
    });
    assert.deepEqual(port.written.trimEnd().split('\n'), lines);
    assert.deepEqual(
      sent.map(({ command, answer, sent, total }) => [command, answer, sent, total]),
      lines.map((line, k) => [line, 'Done', k + 1, lines.length]),
    );
    assert.deepEqual(port.opened, [{ baudRate: 115_200, bufferSize: 65_536 }]);
    assert.equal(port.closed, 1);
  });

  const refusals = {
    'Error -1': /^profileCfg/,
    'Exception: assertion failed': /^chirpCfg/,
    "'frameCfgg' is not recognized as a CLI command": /^frameCfg/,
  };
  for (const [said, pattern] of Object.entries(refusals)) {
    test(`ends with a line that is refused: ${said}`, async () => {
      const at = lines.findIndex((line) => pattern.test(line));
      const port = new FakePort((line) => (pattern.test(line) ? said : 'Ignored: already stopped\r\nDone'));
      const sent = [];
      const sending = sendConfiguration(port, cfg.toString(), { onLine: (line) => sent.push(line) });
      await assert.rejects(sending, (error) => {
        assert.equal(error.code, 'command-refused');
        assert.match(error.details.what, new RegExp(`^line \\d+, ${lines[at]}$`));
        assert.equal(error.details.given, said);
        return true;
      });
      assert.equal(sent.length, at);
      assert.equal(port.written.trimEnd().split('\n').length, at + 1);
      assert.equal(port.closed, 1);
    });
  }

  test('says where no answer came, or the board went', async () => {
    const silent = new FakePort((line) => (line.startsWith('flushCfg') ? null : 'Done'));
    const late = sendConfiguration(silent, cfg.toString(), { timeoutMs: 50 });
    await rejectsTyped(late, 'command-timeout');
    await late.catch(({ details }) => assert.match(details.what, /^line \d+, flushCfg$/));
    assert.equal(silent.closed, 1);
    const leaving = new FakePort((line, port) => {
      if (line.startsWith('profileCfg')) port.unplug();
      return line.startsWith('profileCfg') ? null : 'Done';
    });
    await rejectsTyped(sendConfiguration(leaving, cfg.toString()), 'port-lost');
    const absent = new FakePort();
    absent.plugged = false;
    await rejectsTyped(sendConfiguration(absent, 'sensorStop'), 'port-not-opened');
  });

  test('goes on over noise, and ends when it is told to', async () => {
    const port = new FakePort((line, port) => {
      port.fail('FramingError');
      return line.startsWith('sensorStart') ? null : 'Done';
    });
    const ending = new AbortController();
    const sending = sendConfiguration(port, cfg.toString(), { signal: ending.signal });
    await until(() => port.written.includes('sensorStart'));
    ending.abort(new RangeError('enough'));
    await assert.rejects(sending, RangeError);
    assert.equal(port.closed, 1);
  });

  test('goes over a port that stays open, to firmware without prompts', async () => {
    const port = new FakePort();
    await port.open({ baudRate: 115_200 });
    const sending = sendConfiguration(port, '% a comment\n\nsensorStop % and another\n');
    await until(() => port.written === 'sensorStop\n');
    port.feed('sensor');
    port.feed('Stop\nDo');
    port.feed('ne\n');
    await sending;
    assert.equal(port.closed, 0);
    assert.deepEqual([port.readable.locked, port.writable.locked], [false, false]);
  });
});
