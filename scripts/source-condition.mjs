/** The condition by which the packages of this project export their sources, so that nothing is built to run or to test them. */
export const sourceCondition = 'source';

/** Returns the resolution of a bundler that takes these packages from their sources; `platform`: 'browser' or 'node'. */
export const sourceResolution = (platform) => ({
  conditionNames: [
    sourceCondition,
    ...(platform === 'browser' ? ['browser'] : ['node']),
    'import',
    'module',
    'default',
  ],
});

/** Returns the NODE_OPTIONS of a child process that resolves these packages to their sources. */
export function withSourceCondition(options = '') {
  const option = `--conditions=${sourceCondition}`;
  return options.includes(option) ? options : `${options} ${option}`.trim();
}
