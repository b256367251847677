const rust = (name) => ['cargo', 'test', '--quiet', '-p', `boresight-${name}`];
const steps = (names) => ['node', 'scripts/test.mjs', '--only', names];

/**
 * Mistakes that the tests have to detect. In `file`, `from` is replaced by `to`; then one of the commands has to fail.
 * Commands in `test` are parts of `npm test`, commands in `all` parts of `npm run test:all`.
 */
export const MUTATIONS = [
  {
    name: 'sign in MUSIC',
    file: 'crates/aoa/src/model/subspace.rs',
    from: 'let mut projector = -basis.dot(',
    to: 'let mut projector = basis.dot(',
    test: [rust('aoa')],
  },
  {
    name: 'unit in a binding',
    file: 'crates/wasm/src/trajectory.rs',
    from: 'trajectory::integrate(&motions, angle_deg.to_radians(), x_m, y_m)',
    to: 'trajectory::integrate(&motions, angle_deg, x_m, y_m)',
    test: [steps('build-quick'), steps('node')],
  },
  {
    name: 'off by one in CFAR',
    file: 'crates/signal/src/cfar/stencil.rs',
    from: 'doppler_guard + 1..doppler_reach + 1',
    to: 'doppler_guard + 1..doppler_reach',
    test: [rust('signal')],
  },
  {
    name: 'swapped options',
    file: 'crates/pipeline/src/chain.rs',
    from: '[options.range_doppler.range_padding, options.range_doppler.doppler_padding]',
    to: '[options.range_doppler.doppler_padding, options.range_doppler.range_padding]',
    test: [rust('pipeline')],
  },
  {
    name: 'stale generated file',
    file: 'web/lib/generated/options.ts',
    from: ' * - `none`: Plain IAA.',
    to: ' * - `none`: Plain.',
    test: [[...rust('options'), '-p', 'boresight-generate']],
  },
  {
    name: 'axis of a page',
    file: 'web/plots/axes.ts',
    from: '60, 90],\n  descending: true,',
    to: '60, 90],',
    test: [steps('build-quick'), steps('flows')],
    all: [['node', '--test', 'tests/browser/site/sides.test.mjs']],
  },
  {
    name: 'error code',
    file: 'crates/formats/src/error.rs',
    from: '"malformed-table"',
    to: '"bad-table"',
    test: [rust('formats'), rust('cli')],
  },
  {
    name: 'bound of a reader',
    file: 'crates/formats/src/npy/header.rs',
    from: 'lengths.len() > MAX_AXES',
    to: 'lengths.len() > usize::MAX - 1',
    test: [rust('formats')],
  },
  {
    name: 'standard deviation of a calibration, a third too small',
    file: 'crates/mounting/src/batch.rs',
    from: 'let sigma = covariance[0][0].sqrt();',
    to: 'let sigma = covariance[0][0].sqrt() / 1.5;',
    test: [rust('mounting')],
  },
  {
    name: 'cancellation of a worker',
    file: 'web/worker/pool.ts',
    from: 'const onAbort = (): void => job.reject(signal?.reason);',
    to: 'const onAbort = (): void => {};',
    test: [steps('build-quick'), steps('node')],
  },
];

/** The text with the mistake. Throws unless `from` occurs exactly once. */
export function mutated(text, { name, file, from, to }) {
  const parts = text.split(from);
  if (parts.length !== 2) throw new Error(`${name}: ${file} has “${from}” ${parts.length - 1} times`);
  return parts.join(to);
}
