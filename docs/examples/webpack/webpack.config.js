// Nothing of this is for Boresight: webpack finds worker and modules by itself, and copies them beside the bundle.
export default {
  mode: 'production',
  entry: './src/main.js',
  output: { clean: true },
  // The modules come when they are needed, and are larger than webpack would have what a page loads first.
  performance: { hints: false },
};
