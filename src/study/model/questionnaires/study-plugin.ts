import * as v from 'valibot';
import { inLanguage, words } from '../phrases/localized-text';
import type { QuestionKind } from './question-kind';
import { registerQuestionKind } from './question-kinds';

/**
 * The tools that a plug-in is called with. With them it needs no imports, so that one file runs in the server, in the
 * command line tools and in the page. The page adds its own.
 */
export interface StudyPluginTools {
  readonly v: typeof v;
  readonly words: typeof words;
  readonly inLanguage: typeof inLanguage;
}

/** What a plug-in adds. `questionViews` are used by the page alone. */
export interface StudyPlugin<View = unknown> {
  readonly questionKinds?: readonly QuestionKind[];
  readonly questionViews?: readonly View[];
}

/**
 * Calls the default export of a plug-in module with the tools and registers its kinds of questions. Throws an Error
 * that names `source` if the module is no plug-in or a kind is registered already.
 *
 * @example
 * // The module: export default ({ v, words }) => ({ questionKinds: [{ kind: 'agreement', … }] });
 * installStudyPlugin(await import('./agreement.mjs'), 'agreement.mjs');
 */
export function installStudyPlugin<View = unknown>(
  module: { readonly default?: unknown },
  source: string,
  pageTools: object = {},
): StudyPlugin<View> {
  const create = module.default;
  if (typeof create !== 'function') throw new Error(`${source}: the default export of a plug-in must be a function.`);
  const tools: StudyPluginTools = { v, words, inLanguage };
  const plugin: StudyPlugin<View> = create({ ...tools, ...pageTools });
  for (const kind of plugin.questionKinds ?? []) registerQuestionKind(kind);
  return plugin;
}
