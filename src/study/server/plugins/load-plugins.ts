import { pathToFileURL } from 'node:url';
import { reasonOf } from 'threepoint/core';
import { ConfigurationError } from 'threepoint-http';
import { installStudyPlugin } from '../../model/questionnaires/study-plugin';
import { studyPluginPaths } from './plugin-paths';

/**
 * Loads the plug-ins of THREEPOINT_STUDY_PLUGINS into this process or thread, before it reads a plan. Rejects with a
 * ConfigurationError that names the file.
 */
export async function loadStudyPlugins(environment: Readonly<Record<string, string | undefined>>): Promise<void> {
  for (const path of studyPluginPaths(environment)) {
    try {
      installStudyPlugin(await import(pathToFileURL(path).href), path);
    } catch (error) {
      throw new ConfigurationError(`THREEPOINT_STUDY_PLUGINS: ${path} could not be loaded. ${reasonOf(error)}`);
    }
  }
}
