import type { StudyRun } from 'threepoint-study/participant';
import type { ActivityRunner } from '../../activity/activity';

/** The study that the user of this page takes part in. */
export interface PageStudy {
  /** null: the user takes part in no study. */
  run: StudyRun | null;
  /** The activities that the study runs as tasks, by name. */
  runners: Readonly<Record<string, ActivityRunner>>;
}
