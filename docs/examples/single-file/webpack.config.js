// One file each for a page (`panel.mount`), for hosts that load AMD modules, as Grafana does, and for those that load
// CommonJS by `new Function`, as Foxglove and Lichtblick do.
const formats = { page: { name: 'panel', type: 'var' }, amd: { type: 'amd' }, commonjs: { type: 'commonjs2' } };

export default Object.entries(formats).map(([name, library]) => ({
  name,
  mode: 'production',
  entry: './src/panel.js',
  output: { filename: `panel.${name}.js`, library, asyncChunks: false },
  // What asks for the package gets the one file that holds modules and worker as text. The elements ask for a pool.
  resolve: { alias: { boresight$: 'boresight/inline', 'boresight/worker$': 'boresight/inline' } },
  performance: { hints: false },
}));
