import type { StudyRun } from 'threepoint-study/participant/study-run';
import type { ArcheryRunner } from './study-archery';
import type { BallRunner } from './study-ball';

/** A study on this page, and what it hears of the games it plays. */
export interface JoinedStudy {
  readonly run: StudyRun;
  /** Every frame of the round on the page. */
  readonly archery: Pick<ArcheryRunner, 'played'>;
  /** Every frame of the match on the page. */
  readonly ball: Pick<BallRunner, 'played'>;
}

/** The study that this page takes part in, once it has joined one; until then, and on most pages for good, there is none. */
export class PageStudy {
  #joined: JoinedStudy | null = null;

  /** From now on this study decides what is played and with which body. */
  join(joined: JoinedStudy): void {
    this.#joined = joined;
  }

  /** null: none. */
  get joined(): JoinedStudy | null {
    return this.#joined;
  }

  /** null: none. */
  get run(): StudyRun | null {
    return this.#joined?.run ?? null;
  }

  /** A study is there in which no one plays now. */
  get idle(): boolean {
    return this.run?.idle ?? false;
  }

  /** A study has the round on the page stand still. */
  get paused(): boolean {
    return this.run?.paused ?? false;
  }
}
