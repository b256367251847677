/** What is live as code: a board or a recording in its place, or the frames of a bridge. */
import { type Code, inRepository, NEEDS, nothing, type Part, sentences, textOf } from '../../code/code.ts';
import { quoted } from '../../code/literal.ts';
import { flags, withoutDefaults } from '../../code/options.ts';
import { Script } from '../../code/script.ts';
import { command, fileWord } from '../../code/shell.ts';
import { BUNDLED } from './files.ts';
import { profile } from './profile.ts';
import { live } from './session.ts';
import { bridgeAddress, chainOptions, liveState } from './state.ts';

const FOLDER = 'recordings/awr1642/';

export function liveCode(): Code {
  const now = live.peek();
  if (now?.kind === 'bridge' || (!now && liveState.peek().source === 'raw')) return bridgeCode();
  if (!now) return nothing('Nothing is live yet.');
  return now.kind === 'board' ? boardCode() : recordingCode(now.name);
}

const cfgName = (): string => profile.peek()?.name ?? 'profile.cfg';

/** What a script does with frames. */
const PRINTED = [
  'for await (const { frameNumber, objects } of frames)',
  '  for (const { rangeM, rateMps, azimuthDeg } of objects) console.log(frameNumber, rangeM, rateMps, azimuthDeg);',
  'console.error(frames.counts);',
];

function recordingCode(name: string): Code {
  const bundled = name === BUNDLED;
  const path = (file: string): string => (bundled ? FOLDER + file : file);
  const needs = bundled ? inRepository('the recording', FOLDER) : NEEDS.own([name, cfgName()]);
  const script = new Script()
    .use('node:fs/promises', 'readFile')
    .use('boresight', 'boardFrames', 'init', 'replayBytes')
    .add('await init();')
    .add(`const dat = await readFile(${quoted(path(name))});`)
    .add(`const cfg = await readFile(${quoted(path(cfgName()))}, 'utf8');`)
    .add('const frames = boardFrames(replayBytes(dat, { rate: Infinity }), cfg);')
    .add(...PRINTED);
  const words = ['boresight', 'estimate', fileWord(path(name)), '--config', fileWord(path(cfgName())), '--json'];
  return {
    javascript: part(script.text(), sentences(NEEDS.package, needs), ['The script reads as fast as it can.']),
    commandLine: part(textOf([command(words)]), sentences(NEEDS.program, needs), []),
  };
}

function boardCode(): Code {
  const { commandBaud, dataBaud } = liveState.peek();
  const script = new Script()
    .use('boresight', 'boardFrames', 'init', 'sendConfiguration', 'serialBytes')
    .add('await init();')
    .add(`const cfg = await (await fetch(${quoted(cfgName())})).text();`)
    .add('// Each in answer to a click, as browsers ask for it.')
    .add('const command = await navigator.serial.requestPort();')
    .add('const data = await navigator.serial.requestPort();')
    .add(`const frames = boardFrames(serialBytes(data, { baudRate: ${dataBaud} }), cfg);`)
    .add(`sendConfiguration(command, cfg, { baudRate: ${commandBaud} }).catch(console.error);`)
    .add(...PRINTED);
  const lacks = [
    'The command line reads no serial port; it reads the .dat that this page saves, by boresight estimate.',
  ];
  return {
    javascript: part(
      script.text(),
      sentences('A page with the package, in a browser with Web Serial.', NEEDS.own([cfgName()])),
      [],
    ),
    commandLine: part('', '', lacks),
  };
}

function bridgeCode(): Code {
  const state = liveState.peek();
  const all = chainOptions(state);
  const options = withoutDefaults('DetectionOptions', all);
  const { angle = {}, ...chain } = all;
  const script = new Script()
    .use('boresight', 'bridgeFrames', 'Capture', 'init')
    .add('await init();')
    .constant('options', options)
    .add(`const frames = bridgeFrames(${quoted(bridgeAddress(state))});`)
    .add('for await (const { number, bytes } of frames) {')
    .add('  const capture = new Capture(bytes, frames.hello.config);')
    .add('  for (const { rangeM, rateMps, azimuthDeg } of capture.processFrame(0, options).detections)')
    .add('    console.log(number, rangeM, rateMps, azimuthDeg);')
    .add('  capture.free();')
    .add('}');
  const estimate = ['boresight', 'estimate', 'capture.bin', '--config', fileWord(cfgName()), '--each', '--json'];
  const words = [
    command(['boresight', 'bridge', '--config', fileWord(cfgName()), '--port', String(state.bridge)]),
    '# Of a recording, the same detections:',
    command([...estimate, ...flags('DetectionOptions', chain), ...flags('DetectionOptions.angle', angle)]),
  ];
  return {
    javascript: part(script.text(), 'Node 22 or newer and the package: npm install boresight. A running bridge.', []),
    commandLine: part(textOf(words), sentences(NEEDS.program, NEEDS.own([cfgName(), 'capture.bin'])), []),
  };
}

const part = (text: string, needs: string, lacks: readonly string[]): Part => ({ text, needs, lacks });
