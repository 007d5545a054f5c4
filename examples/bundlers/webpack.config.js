export default {
  mode: 'production',
  entry: './main.js',
  output: { path: `${import.meta.dirname}/dist/webpack`, filename: 'main.js' },
  // three.js alone is larger than webpack's hint at 250 kB.
  performance: { hints: false },
};
