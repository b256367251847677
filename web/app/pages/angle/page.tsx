import { useSignalEffect } from '@preact/signals';
import { fixed, signed } from '../../../plots/format.ts';
import { useAddress } from '../../state/address.ts';
import { announce } from '../../state/announce.ts';
import { About } from '../../ui/about.tsx';
import { MainColumn } from '../../ui/main-column.tsx';
import { ArrayPanel } from './array-panel.tsx';
import { caption, start as startCompare } from './compare.ts';
import { ComparePanel } from './compare-panel.tsx';
import { answers, results, sceneProblem, start } from './compute.ts';
import { Controls } from './controls.tsx';
import { ResultsTable } from './results-table.tsx';
import { SpectrumPlot } from './spectrum-plot.tsx';
import { angleCodec, angleState } from './state.ts';
import { SweepPanel } from './sweep-panel.tsx';

export function AnglePage() {
  useAddress('angle', {
    codec: angleCodec,
    restore: (params) => {
      angleState.value = angleCodec.read(params);
    },
    start: () => {
      const stops = [start(), startCompare()];
      return () => {
        for (const stop of stops) stop();
      };
    },
    write: () => angleCodec.write(angleState.value),
    caption,
  });
  useSignalEffect(() => {
    const lines = [...results.value]
      .filter(([, result]) => result.estimate)
      .map(
        ([method, { estimate }]) =>
          `${method}: ${estimate?.sources.map((source) => `${signed(source.azimuthDeg, 1)} degrees`).join(', ') || 'none'}`,
      );
    if (lines.length) announce(`Estimates. ${lines.join('. ')}.`);
  });
  const problem = sceneProblem.value;
  const present = answers.value;
  return (
    <div class="page">
      <Controls />
      <MainColumn>
        {problem && (
          <p class="alert" role="alert" data-error={problem.code}>
            <strong>Cannot simulate this.</strong> {problem.message} <code>{problem.code}</code>
          </p>
        )}
        {present ? (
          <>
            <SpectrumPlot {...present} />
            <ComparePanel {...present} />
            <ResultsTable {...present} />
            <SweepPanel />
            <ArrayPanel scene={present.scene} />
          </>
        ) : (
          !problem && <p class="panel loading">Computing the first scene</p>
        )}
        <About title="About the angle lab">
          <p>
            Plane waves from the targets reach the array; each snapshot is <i>y = Σ a(θ) s + n</i>. Targets fluctuate
            from snapshot to snapshot, in phase alone or not at all, as chosen. Everything is drawn anew from the seed
            at each change, so a link shows the same numbers anywhere.
          </p>
          <p>
            <b>Levels</b> are in dB relative to a 0 dB target at one element; SNR is its power over the noise power at
            one element. Power spectra (Bartlett, Capon, IAA, sparse Bayesian learning) are drawn as they are.
            Pseudo-spectra (MUSIC, min-norm) have no power of their own and are shifted so that their highest peak meets
            the strongest estimate.
          </p>
          <p>
            <b>Signs.</b> Azimuth is positive to the left of boresight, counter-clockwise seen from above. An estimate
            is counted for a target when it lies within one beam width of it
            {present ? ` (${fixed(present.scene.geometry.resolutionDeg, 1)}° here)` : ''}, nearest pairs first.
          </p>
          <p>
            <b>Bounds</b> are Cramér–Rao bounds of an unbiased estimator that knows the array exactly: the stochastic
            one for fluctuating targets, else the deterministic one. Imperfections of the array are not in them.
          </p>
        </About>
      </MainColumn>
    </div>
  );
}
