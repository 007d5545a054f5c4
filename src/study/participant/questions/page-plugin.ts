import { button, element } from 'threepoint-ui';
import { installStudyPlugin, type StudyPluginTools } from '../../model/questionnaires/study-plugin';
import type { QuestionView } from './question-view';
import { registerQuestionView } from './question-views';

/** The tools that a plug-in is called with in the page. */
export interface PagePluginTools extends StudyPluginTools {
  readonly element: typeof element;
  readonly button: typeof button;
}

/** Registers the kinds of questions of a plug-in module, and their views. Built pages call it (vite.config.ts). */
export function installPagePlugin(module: { readonly default?: unknown }, source: string): void {
  const { questionViews = [] } = installStudyPlugin<QuestionView>(module, source, { element, button });
  for (const view of questionViews) registerQuestionView(view);
}
