import type { TrackingFrame } from 'threepoint/core/tracking/tracking-frame';
import type { ParticipantClient } from '../client/study-client';
import { RunningStudy } from './running-study';
import { StudyEntrance } from './study-entrance';
import { forgetSession, openSession } from './study-opening';
import type { StudyPage } from './study-page';
import type { StudyHost } from './trial/study-host';

/** The study in the address; `participant` null: the address names none. */
export interface AskedStudy {
  readonly study: string;
  readonly participant: string | null;
}

/** The state of a visit, for tools. */
export interface VisitState {
  readonly screen: string;
  readonly step: string | null;
  readonly simulated: boolean;
  readonly running: boolean;
  readonly unsent: number;
  readonly unsaved: number;
  readonly online: boolean;
}

/** A visit of the page for a study: its entrance, then the session until the page closes. */
export class StudyVisit {
  readonly #page: StudyPage;
  readonly #entrance: StudyEntrance;
  #running: RunningStudy | null = null;

  constructor(asked: AskedStudy, client: ParticipantClient, host: StudyHost, page: StudyPage) {
    this.#page = page;
    const options = {
      client,
      now: page.now,
      onChange: () => this.#running?.show(),
      onCommand: () => this.#running?.conclude(),
    };
    this.#entrance = new StudyEntrance(asked, {
      page,
      open: (participant) => openSession({ study: asked.study, participant }, options),
      onSession: (session) => {
        const { participant } = session.progress;
        const forget = () => forgetSession({ study: asked.study, participant });
        this.#running = new RunningStudy(session, { host, page, forget });
        this.#running.begin();
      },
    });
  }

  /** Resolves when the session is open or a form asks for what is missing. */
  enter(): Promise<void> {
    return this.#entrance.enter();
  }

  /** Whether no trial is being played, so that hands that point at the sheet draw no bow. */
  get idle(): boolean {
    return !this.#running?.playing;
  }

  /** Whether the round on the page is paused. */
  get paused(): boolean {
    return this.#running?.paused ?? false;
  }

  /** Whether closing the page would lose answers. */
  get losesAnswers(): boolean {
    const { unsaved, unsent } = this.state();
    return unsaved > 0 && unsent > 0;
  }

  /** Takes a drawn frame into account; null: the head was not seen. */
  frame(time: number, frame: TrackingFrame | null): void {
    this.#running?.frame(time, frame);
  }

  /** Called when the headset was put on or taken off. */
  sessionChanged(): void {
    this.#running?.sessionChanged();
  }

  /** Exchanges with the server at once; resolves when that is over. */
  async exchange(): Promise<void> {
    await this.#running?.exchange();
  }

  state(): VisitState {
    const running = this.#running;
    const { unsent, unsaved, online } = running?.session.uploadStatus ?? { unsent: 0, unsaved: 0, online: true };
    return {
      screen: this.#page.display.shown,
      step: running?.session.step.id ?? null,
      simulated: running?.session.simulated ?? false,
      running: running?.playing ?? false,
      unsent,
      unsaved,
      online,
    };
  }
}
