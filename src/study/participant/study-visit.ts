import { formatSentence } from 'threepoint-ui';
import type { ParticipantClient } from '../client/study-client';
import { inLanguage } from '../model/phrases/localized-text';
import { type Phrases, phrasesOf, preferredLanguage, shippedLanguages } from '../model/phrases/phrases';
import { Rejection } from '../model/progress/rejection';
import type { PublicStudy } from '../model/progress/study-api';
import { localizedReason } from './localized-reasons';
import { forgetSession, type OpenedSession, openSession } from './open-session';
import type { ParticipantSession } from './session/participant-session';
import { SessionFlow } from './session-flow';
import type { StudyPage } from './study-page';
import type { StudyHost } from './trial/study-host';

/** The study in the address; `participant` null: the address names none. */
export interface RequestedStudy {
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

type NewSession = Extract<OpenedSession, { kind: 'new' }>;

/** A visit of the page for a study: participant, invitation and consent, then the session until the page closes. */
export class StudyVisit {
  readonly #requested: RequestedStudy;
  readonly #client: ParticipantClient;
  readonly #host: StudyHost;
  readonly #page: StudyPage;
  #flow: SessionFlow | null = null;

  constructor(requested: RequestedStudy, client: ParticipantClient, host: StudyHost, page: StudyPage) {
    this.#requested = requested;
    this.#client = client;
    this.#host = host;
    this.#page = page;
  }

  /** Resolves when the session is open or a form asks for missing input; faults are shown. */
  async enter(): Promise<void> {
    const { participant } = this.#requested;
    if (participant === null) {
      this.#askForParticipant(null);
      return;
    }
    try {
      const opened = await this.#open(participant);
      const invitation = this.#page.address.invitation();
      if (opened.kind === 'resumed') this.#begin(opened.session);
      else if (invitation === null) this.#askForParticipant(opened.study);
      else this.#askForConsent(opened, participant, invitation);
    } catch (error) {
      this.#page.display.ask({ kind: 'fault', ...this.#problem(error) });
    }
  }

  /** The flow of the session; null: it is not open yet. */
  get flow(): SessionFlow | null {
    return this.#flow;
  }

  get losesAnswers(): boolean {
    const { unsaved, unsent } = this.state();
    return unsaved > 0 && unsent > 0;
  }

  state(): VisitState {
    const { flow } = this;
    const { unsent, unsaved, online } = flow?.session.uploadStatus ?? { unsent: 0, unsaved: 0, online: true };
    return {
      screen: this.#page.display.shown,
      step: flow?.session.step.id ?? null,
      simulated: flow?.session.simulated ?? false,
      running: flow?.playing ?? false,
      unsent,
      unsaved,
      online,
    };
  }

  #open(participant: string): Promise<OpenedSession> {
    return openSession(
      { study: this.#requested.study, participant },
      {
        client: this.#client,
        now: this.#page.now,
        storageLimitMs: this.#page.storageLimitMs,
        onChange: () => this.#flow?.show(),
        onCommand: () => this.#flow?.onCommand(),
      },
    );
  }

  #begin(session: ParticipantSession): void {
    const { participant } = session.progress;
    const forget = () => forgetSession({ study: this.#requested.study, participant });
    this.#flow = new SessionFlow(session, { host: this.#host, page: this.#page, forget });
    this.#flow.begin();
  }

  /** Returns the study's language that the user of the browser reads, or one of the page without a study. */
  #languageOf(study: PublicStudy | null): string {
    return preferredLanguage(study?.languages ?? shippedLanguages, this.#page.languages);
  }

  #phrasesOf(study: PublicStudy | null): Phrases {
    return phrasesOf(study ?? {}, this.#languageOf(study));
  }

  #problem(error: unknown): { readonly phrases: Phrases; readonly text: string } {
    const phrases = this.#phrasesOf(null);
    const unknown = error instanceof Rejection && error.reason === 'unknown';
    const text = unknown
      ? phrases.text('entrance.noStudy', { study: this.#requested.study })
      : localizedReason(error, phrases);
    return { phrases, text };
  }

  /**
   * Asks for participant and invitation if the address lacks them. `complaint` is what was wrong with the address, in
   * the language of `phrases`.
   */
  #askForParticipant(study: PublicStudy | null, phrases = this.#phrasesOf(study), problem: string | null = null): void {
    const { display, address } = this.#page;
    // A link that is pasted into the address of this tab may change its fragment only.
    address.reloadWhenChanged();
    display.ask({
      kind: 'participant',
      phrases,
      problem,
      known: { participant: this.#requested.participant, invitation: address.invitation() },
      go: (invited) => address.goTo(invited),
      decline: () => display.ask({ kind: 'declined', phrases, title: phrases.text('study') }),
    });
  }

  #askForConsent({ study, agree }: NewSession, participant: string, invitation: string): void {
    const { display } = this.#page;
    display.ask({
      kind: 'consent',
      phrases: this.#phrasesOf(study),
      language: this.#languageOf(study),
      study,
      participant,
      agree: async (choices) => {
        const { contact } = study;
        const phrases = phrasesOf(study, choices.language ?? study.languages[0]);
        const taken = await agree(choices, invitation);
        if (taken === 'uninvited') {
          const problem =
            contact === null
              ? phrases.text('entrance.wrongInvitation', { participant })
              : phrases.text('entrance.wrongInvitationRemote', { participant, contact });
          this.#askForParticipant(study, phrases, problem);
          return null;
        }
        if (taken === 'changed') {
          this.#page.address.reload();
          return null;
        }
        if ('why' in taken) {
          return `${formatSentence(localizedReason(taken.why, phrases))} ${contact ?? phrases.text('askExperimenter')}`;
        }
        this.#begin(taken);
        return null;
      },
      decline: (phrases) =>
        display.ask({ kind: 'declined', phrases, title: inLanguage(study.title, phrases.language) }),
    });
  }
}
