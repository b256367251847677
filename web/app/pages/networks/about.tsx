import { About } from '../../ui/about.tsx';

export function AboutNetworks() {
  return (
    <About title="About this page">
      <p>
        <b>AAETR and the learned pursuit</b> answer one snapshot with a set of targets: the sine of each azimuth, its
        amplitude and a confidence. They must not be told how many there are. AAETR is a transformer; the learned
        pursuit has no attention, and its steps subtract what they have found. Both are for the array on their card.{' '}
        <b>UAA</b> answers one snapshot with a power spectrum, by iterations of IAA as layers without matrix inverses.{' '}
        <b>Covariance CNN and DeepMUSIC</b> see the covariance of many snapshots of 16 elements, for sources that are
        not coherent. <b>Counting network, DNN and 3D-CNN</b> see a region of interest of a data cube, 65 range bins of
        8 elements and 4 chirps: the first two its covariance, the last the region itself. They tell whether there are
        none, one or two targets, and in which of the whole degrees from −10 to 10 these lie; they have no answer
        between two degrees.
      </p>
      <p>
        All were trained on simulated data alone, by the code in <code>training/</code>, for as long as each card says,
        on the hardware it names. The networks of the papers’ authors are not here, and nothing here says how good they
        are. What these do outside the data of their cards is not known, and the pages say so where an array or a field
        of view differs.
      </p>
      <p>
        <b>Refinement</b> takes what a method found to the best fit of the model by Gauss-Newton steps, adds what stands
        out of the rest and drops what noise explains. After it little may be left of what the network found by itself:
        compare with refined IAA.
      </p>
      <p>
        Networks run in this tab, in WebAssembly, on workers. The module that runs them and each network’s file are
        fetched when one is first used, and kept while the tab is open. Files of your own stay on your machine.
      </p>
    </About>
  );
}
