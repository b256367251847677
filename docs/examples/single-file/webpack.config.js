// One file for pages (`panel.mount`) and for hosts that load AMD modules, as Grafana does, and one for those that load
// CommonJS by `new Function`, as Foxglove and Lichtblick do.
const single = (entry, filename, library) => ({
  mode: 'production',
  entry,
  output: { filename, library, asyncChunks: false },
  // What asks for the package gets the one file that holds modules and worker as text. The elements ask for a pool.
  resolve: { alias: { boresight$: 'boresight/inline', 'boresight/worker$': 'boresight/inline' } },
  performance: { hints: false },
});

export default [
  single('./src/panel.js', 'panel.js', { name: 'panel', type: 'umd' }),
  single('./src/extension.js', 'extension.js', { type: 'commonjs2' }),
];
