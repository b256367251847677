// Tables of the experiment of regions that lay what networks make of whole frames beside what they make of regions they
// are told.

const SCENES = { none: 'none', one: 'one', apart: 'two, at ranges of their own', together: 'two, at one range' };
const COUNTED = { none: 0, one: 1, apart: 2, together: 2 };
const COUNTING = 'counting';
/** Networks that answer, by the targets they answer for. */
const ANGLES = { 1: ['cnn3d-1'], 2: ['cnn3d-2', 'cnn3d-paper-2'] };

const percent = (share) => (share === null ? '' : (100 * share).toFixed(1));

/** Shares of scenes by condition of one brief record: counted rightly, and with every angle of a method within 1 deg. */
function shares({ conditions, counters, methods }) {
  const of = (targets) => conditions.filter((condition) => condition.targets === targets);
  return {
    counted: (targets) => of(targets).map(({ counted }) => counted[counters.indexOf(COUNTING)][COUNTED[targets]]),
    right: (targets, method) => of(targets).map((condition) => condition.methods[methods.indexOf(method)].success),
    levels: of('none').map(({ snrDb }) => `${snrDb} dB`),
  };
}

function table(title, levels, rows) {
  const line = (cells) => `| ${cells.join(' | ')} |`;
  return [title, '', line(['targets', '', ...levels]), `|${'---|'.repeat(levels.length + 2)}`, ...rows.map(line), ''];
}

/**
 * Two tables as a command would print them, from the brief records of regions that are told, of whole frames, and of
 * whole frames with the targets around 35 deg.
 */
export function endToEndTables(told, whole, around) {
  const [regions, frames, aside] = [told, whole, around].map(shares);
  const row = (first, name, values) => [first, name, ...values.map(percent)];
  const counted = Object.entries(SCENES).flatMap(([targets, words]) => [
    row(words, 'told', regions.counted(targets)),
    row('', 'end to end', frames.counted(targets)),
    row('', 'around 35 deg', aside.counted(targets)),
  ]);
  const angles = Object.entries(SCENES).flatMap(([targets, words]) =>
    (ANGLES[COUNTED[targets]] ?? []).flatMap((method) => {
      const among = ({ right, counted: count }) =>
        right(targets, method).map((share, i) => (count(targets)[i] > 0 ? share / count(targets)[i] : null));
      return [
        row(`${words}, ${method}`, 'told', regions.right(targets, method)),
        row('', 'end to end, all', frames.right(targets, method)),
        row('', 'counted rightly', among(frames)),
        row('', 'around 35 deg, counted rightly', among(aside)),
      ];
    }),
  );
  return [
    ...table('Scenes counted rightly, %, told the region and from end to end.', regions.levels, counted),
    ...table('Every angle within 1 deg, %, told the number of targets and from end to end.', regions.levels, angles),
  ].join('\n');
}
