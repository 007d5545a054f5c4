/** The export condition under which this project's packages export their sources, so that they run without a build. */
const sourceCondition = 'source';

/** Returns a bundler's resolve options that map these packages to their sources; `platform`: 'browser' or 'node'. */
export const sourceResolution = (platform) => ({
  conditionNames: [sourceCondition, platform, 'import', 'module', 'default'],
});

/** Returns the NODE_OPTIONS of a child process that resolves these packages to their sources. */
export function withSourceCondition(options = '') {
  const option = `--conditions=${sourceCondition}`;
  return options.includes(option) ? options : `${options} ${option}`.trim();
}
