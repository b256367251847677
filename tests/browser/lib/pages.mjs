/** Pages of the demo, and a selector that is there once a page has shown its data. */
export const pages = [
  { name: 'angle lab', path: '#/angle', ready: '[data-row="music"] [data-field="azimuth"][data-value]' },
  { name: 'capture', path: '#/capture', ready: '[data-row="bartlett"] [data-field="azimuth"][data-value]' },
  {
    name: 'mounting angle',
    path: '#/mounting',
    ready: '[aria-busy="false"] [data-row="recursive"] [data-field="angleDeg"][data-value]',
  },
  {
    name: 'birds-eye view',
    path: '#/birdseye',
    ready: '[aria-busy="false"] [data-row="iaa"] [data-field="outsideDb"][data-value]',
  },
  { name: 'networks', path: '#/networks', ready: '[data-card] [data-facts="card"]' },
  {
    name: 'live',
    path: '#/live?play=bundled&pace=fast',
    ready: '[data-live-state="ended"] ~ * [data-plot="board-points"] .plot canvas',
  },
  { name: 'elements', path: '#/elements', ready: '#plots[aria-busy="false"] .gallery-element .plot canvas' },
];
