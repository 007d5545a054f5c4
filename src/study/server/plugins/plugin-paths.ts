import { resolve } from 'node:path';

/**
 * Returns the full paths of the plug-in modules in THREEPOINT_STUDY_PLUGINS, which are separated by commas and relative
 * to the directory in which the command was typed.
 */
export const studyPluginPaths = (environment: Readonly<Record<string, string | undefined>>): readonly string[] =>
  (environment.THREEPOINT_STUDY_PLUGINS ?? '')
    .split(',')
    .map((path) => path.trim())
    .filter(Boolean)
    .map((path) => resolve(environment.INIT_CWD ?? process.cwd(), path));
