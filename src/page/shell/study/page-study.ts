import type { StudyRun } from 'threepoint-study/participant/study-run';
import type { ActivityRunner } from '../../activity/activity';

/** A study that this page has joined, and the activities that it runs as tasks, by name. */
export interface JoinedStudy {
  readonly run: StudyRun;
  readonly runners: Readonly<Record<string, ActivityRunner>>;
}

/** The study that the user of this page takes part in. */
export class PageStudy {
  #joined: JoinedStudy | null = null;

  /** From now on this study decides what is played and with which body. */
  join(joined: JoinedStudy): void {
    this.#joined = joined;
  }

  /** null: the user takes part in no study. */
  get run(): StudyRun | null {
    return this.#joined?.run ?? null;
  }

  /** The task of this name; null: there is no study, or it has no such task. */
  runnerOf(name: string): ActivityRunner | null {
    return this.#joined?.runners[name] ?? null;
  }

  /** No trial is played now. */
  get idle(): boolean {
    return this.run?.idle ?? false;
  }

  /** The study has paused the trial. */
  get paused(): boolean {
    return this.run?.paused ?? false;
  }
}
