/**
 * Mistakes that tests have to find: text of a file and what replaces it, the steps that are run, one of which has to fail,
 * and the tier that these steps are of.
 */
export const MUTATIONS = [
  {
    name: 'sign in MUSIC',
    file: 'crates/aoa/src/model/subspace.rs',
    from: 'let mut projector = -basis.dot(',
    to: 'let mut projector = basis.dot(',
    steps: 'rust',
  },
  {
    name: 'unit in a binding',
    file: 'crates/wasm/src/trajectory.rs',
    from: 'trajectory::integrate(&motions, angle_deg.to_radians(), x_m, y_m)',
    to: 'trajectory::integrate(&motions, angle_deg, x_m, y_m)',
    steps: 'build,node',
  },
  {
    name: 'off by one in CFAR',
    file: 'crates/signal/src/cfar/stencil.rs',
    from: 'doppler_guard + 1..doppler_reach + 1',
    to: 'doppler_guard + 1..doppler_reach',
    steps: 'rust',
  },
  {
    name: 'swapped options',
    file: 'crates/pipeline/src/chain.rs',
    from: '[options.range_doppler.range_padding, options.range_doppler.doppler_padding]',
    to: '[options.range_doppler.doppler_padding, options.range_doppler.range_padding]',
    steps: 'rust',
  },
  {
    name: 'stale generated file',
    file: 'web/lib/generated/options.ts',
    from: ' * - `none`: Plain IAA.',
    to: ' * - `none`: Plain.',
    steps: 'rust',
  },
  {
    name: 'axis of a page',
    file: 'web/plots/axes.ts',
    from: '60, 90],\n  descending: true,',
    to: '60, 90],',
    steps: 'build,build-demo,flows',
    others: 'build,build-demo,browser',
  },
  {
    name: 'error code',
    file: 'crates/formats/src/error.rs',
    from: '"malformed-table"',
    to: '"bad-table"',
    steps: 'rust',
  },
  {
    name: 'bound of a reader',
    file: 'crates/formats/src/npy/header.rs',
    from: 'lengths.len() > MAX_AXES',
    to: 'lengths.len() > usize::MAX - 1',
    steps: 'rust',
  },
  {
    name: 'standard deviation of a calibration, a third too small',
    file: 'crates/mounting/src/batch.rs',
    from: 'let sigma = covariance[0][0].sqrt();',
    to: 'let sigma = covariance[0][0].sqrt() / 1.5;',
    steps: 'rust',
  },
  {
    name: 'cancellation of a worker',
    file: 'web/worker/pool.ts',
    from: 'const onAbort = (): void => job.reject(signal?.reason);',
    to: 'const onAbort = (): void => {};',
    steps: 'build,node',
  },
];

/** The text with the mistake in it; an error where the place is not there exactly once. */
export function mutated(text, { name, file, from, to }) {
  const parts = text.split(from);
  if (parts.length !== 2) throw new Error(`${name}: ${file} has “${from}” ${parts.length - 1} times`);
  return parts.join(to);
}
