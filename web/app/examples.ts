/** What each page is for, in a sentence, and scenes that show it: they are links to the page's own settings. */
import type { Page } from './state/route.ts';

export interface Example {
  title: string;
  /** What there is to see. */
  about: string;
  params: string;
}

export const INTRODUCTIONS: Readonly<Record<Page, { about: string; examples: readonly Example[] }>> = {
  angle: {
    about:
      'Where do echoes come from? Move targets before an antenna array, and see what each method makes of them, and how close to the theoretical bound.',
    examples: [
      {
        title: 'Two targets inside a beam',
        about: 'Six degrees apart where the beam is ten wide: the FFT shows one target, the others two.',
        params: 'array=ula10&targets=-3:0,3:0&snr=20&snapshots=100&seed=1&methods=bartlett,capon,music,root-music',
      },
      {
        title: 'Coherent multipath',
        about:
          'Two paths of one echo: the covariance has rank one, so MUSIC is off by many bounds and Capon loses the power. Averaging and smoothing, under Estimation, bring them back; IAA and maximum likelihood need neither.',
        params:
          'array=ula16&targets=-8:0,6:-3&snr=20&snapshots=50&seed=1&fluctuation=coherent&methods=capon,music,iaa,maximum-likelihood',
      },
      {
        title: 'Grating lobes',
        about:
          'Elements a wavelength apart: spectra are the same at 20 and at −41 degrees, and no method can tell which one it is.',
        params: 'array=at:0,2,4,6,8,10,12,14&targets=20:0&snr=20&snapshots=20&seed=1&methods=bartlett,capon,iaa',
      },
      {
        title: 'One snapshot',
        about: 'What an automotive radar often has: one look. Methods on a covariance have none to work with.',
        params:
          'array=ula16&targets=-5:0,5:0&snr=25&snapshots=1&seed=1&methods=bartlett,single-snapshot-music,iaa,nomp',
      },
      {
        title: '48-element sparse array',
        about: 'A long-range radar: narrow beams, and side lobes everywhere that hide the weak targets from the FFT.',
        params:
          'array=lrr48&targets=-20:0,-18.5:-6,5:-3,6.2:0,30:-10&snr=25&snapshots=1&seed=1&methods=bartlett,iaa,nomp',
      },
      {
        title: 'Masking',
        about: 'A target 18 dB weaker, in the side lobes of a strong one: the FFT hides it, IAA and NOMP do not.',
        params: 'array=ula16&targets=0:0,16:-18&snr=30&snapshots=20&seed=1&methods=bartlett,capon,iaa,nomp',
      },
    ],
  },
  capture: {
    about:
      'From raw samples of a radar board to range, speed and angle: choose a cell of the map to see what each method makes of its direction, or open a recording of your own.',
    examples: [
      {
        title: 'What is in the scene',
        about: 'All frames of a bundled recording together; the board’s own detections are marked.',
        params: 'frame=all&methods=bartlett,capon,iaa',
      },
      {
        title: 'One frame',
        about: 'What 40 ms alone give: one snapshot a cell.',
        params: 'frame=0&methods=bartlett,iaa,nomp',
      },
      {
        title: 'Moving things alone',
        about: 'Static clutter removed: what stands goes, and in this scene that is nearly all.',
        params: 'frame=all&methods=bartlett,capon,iaa&clutter=1',
      },
      {
        title: 'Azimuth and elevation',
        about: 'A street simulated before an AWR1843, whose elements span an area: detections as points in space.',
        params: 'source=simulated&frame=0&methods=bartlett,iaa&points=space&pointColour=height',
      },
      {
        title: 'Regions by networks',
        about: 'A network counts the targets of each region along range, and another tells their angles.',
        params: 'frame=0&methods=bartlett,iaa&regions=1&regionsBy=dnn',
      },
    ],
  },
  mounting: {
    about:
      'Which way does a radar look on its car? What stands still tells by its Doppler while one drives: the angle, how sure it is, and whether the radar was knocked.',
    examples: [
      {
        title: 'A real car in traffic',
        about: 'Ten minutes with a Delphi front radar; its makers state −1.96°.',
        params: 'source=delphi&methods=recursive,weighted-mean,least-squares',
      },
      {
        title: 'City',
        about: 'Simulated: junctions, parked cars, pedestrians. The true angle is known.',
        params: 'source=simulated&scenario=city&duration=120&methods=recursive,weighted-mean,least-squares',
      },
      {
        title: 'Dense traffic',
        about: 'Simulated: cars on all sides at nearly the same speed mislead methods that trust the majority.',
        params: 'source=simulated&scenario=dense-traffic&duration=120&methods=recursive,weighted-mean,least-squares',
      },
      {
        title: 'Car park',
        about: 'Simulated: tight turns at walking pace, forward and in reverse.',
        params: 'source=simulated&scenario=car-park&duration=120&methods=recursive,weighted-mean,least-squares',
      },
    ],
  },
  birdseye: {
    about:
      'What the radars of a car see around it, as an image by each method: the fewer arcs and smears beside true points, the better.',
    examples: [
      {
        title: 'FFT, IAA and NOMP',
        about: 'Four simulated corner and front radars of 48 elements in a street.',
        params: 'source=street&seed=1&methods=bartlett,iaa,nomp',
      },
      {
        title: 'One radar alone',
        about: 'The one at the front left.',
        params: 'source=street&seed=1&radars=front-left&methods=bartlett,iaa,nomp',
      },
      {
        title: 'By a network',
        about: 'The learned pursuit beside IAA.',
        params: 'source=street&seed=1&radars=front-left&methods=iaa,learned-pursuit',
      },
      {
        title: 'A real capture',
        about: 'The recording of the page Capture, eight elements, as an image.',
        params: 'source=capture&seed=1&methods=bartlett,iaa',
      },
    ],
  },
  networks: {
    about:
      'What trained networks can do for a radar: tell angles without being told how many targets there are, or count them. Try one beside the classical methods on the same numbers, and time it here.',
    examples: [
      {
        title: 'A transformer, six targets',
        about: 'AAETR on one snapshot of a 48-element sparse array.',
        params: 'model=aaetr-lrr48&targets=6&snr=25&seed=1&run=1',
      },
      {
        title: 'Any array',
        about: 'One transformer for any array: here the 86 elements of a cascaded board.',
        params: 'model=aaetr-any&array=cascade86&targets=8&snr=25&seed=1&run=1',
      },
      {
        title: 'Far below the noise',
        about: 'A network on the covariance of many snapshots, beside MUSIC.',
        params: 'model=covariance-cnn&targets=2&snr=-12&seed=1&run=1',
      },
      {
        title: 'Two targets in a region',
        about: 'A small DNN on the covariance of a region of a data cube.',
        params: 'model=dnn-small-2&targets=2&snr=10&seed=1&run=1',
      },
      {
        title: 'How many are there?',
        about: 'A counting network beside MDL and AIC.',
        params: 'model=counting-small&targets=2&snr=10&seed=1&run=1',
      },
    ],
  },
  live: {
    about:
      'A radar board on this machine, live: its detections over the serial port of this browser, or raw samples of a capture card over a bridge. A recording stands in where there is no board.',
    examples: [
      {
        title: 'A recorded board',
        about: 'Ten seconds of a TI AWR1642, as they came.',
        params: 'source=board&play=bundled',
      },
      {
        title: 'Faster than its port',
        about: 'The same at ten times what the port could send.',
        params: 'source=board&play=bundled&pace=ten',
      },
      {
        title: 'All at once',
        about: 'The same recording as fast as it can be read.',
        params: 'source=board&play=bundled&pace=fast',
      },
      { title: 'Raw samples', about: 'Of a DCA1000 capture card, over `boresight bridge`.', params: 'source=raw' },
    ],
  },
  elements: {
    about:
      'The plots of this demo for pages and notebooks of your own: each element live, with its options as a form, and the code to copy.',
    examples: [
      { title: 'Spectrum', about: 'Angles and the power over them.', params: 'element=boresight-spectrum' },
      {
        title: 'Range and Doppler',
        about: 'A map with what was detected in it.',
        params: 'element=boresight-range-doppler&set=@colors:magma',
      },
      { title: 'Point cloud', about: 'A scan around the car.', params: 'element=boresight-point-cloud' },
      {
        title: 'Mounting angle',
        about: 'An angle that settles, and its verdict.',
        params: 'element=boresight-mounting-angle',
      },
      { title: 'A drive from its files', about: 'Reads, calibrates and shows.', params: 'element=boresight-drive' },
    ],
  },
};
