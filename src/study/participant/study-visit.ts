import type { TrackingFrame } from 'threepoint/core/tracking/tracking-frame';
import { formatSentence } from 'threepoint-ui/text-format';
import { NoStudyServer, type ParticipantClient, ServerRefusal } from '../client/study-client';
import { inLanguage } from '../model/phrases/localized-text';
import { type Phrases, phrasesOf, preferredLanguage, shippedLanguages } from '../model/phrases/phrases';
import type { PublicStudy } from '../model/progress/study-api';
import { localizedReason } from './localized-reasons';
import { forgetSession, type OpenedSession, openSession } from './open-session';
import type { ParticipantSession } from './session/participant-session';
import { SessionFlow } from './session-flow';
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

type NewSession = Extract<OpenedSession, { kind: 'new' }>;

/** A visit of the page for a study: participant, invitation and consent, then the session until the page closes. */
export class StudyVisit {
  readonly #asked: AskedStudy;
  readonly #client: ParticipantClient;
  readonly #host: StudyHost;
  readonly #page: StudyPage;
  #running: SessionFlow | null = null;

  constructor(asked: AskedStudy, client: ParticipantClient, host: StudyHost, page: StudyPage) {
    this.#asked = asked;
    this.#client = client;
    this.#host = host;
    this.#page = page;
  }

  /** Resolves when the session is open or a form asks for missing input; faults are shown. */
  async enter(): Promise<void> {
    const { participant } = this.#asked;
    if (participant === null) {
      this.#askWho(null);
      return;
    }
    try {
      const opened = await this.#open(participant);
      const invitation = this.#page.address.invitation();
      if (opened.kind === 'resumed') this.#begin(opened.session);
      else if (invitation === null) this.#askWho(opened.study);
      else this.#askForConsent(opened, participant, invitation);
    } catch (error) {
      this.#page.display.ask({ kind: 'fault', ...this.#fault(error) });
    }
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

  #open(participant: string): Promise<OpenedSession> {
    return openSession(
      { study: this.#asked.study, participant },
      {
        client: this.#client,
        now: this.#page.now,
        storageLimitMs: this.#page.storageLimitMs,
        onChange: () => this.#running?.show(),
        onCommand: () => this.#running?.conclude(),
      },
    );
  }

  #begin(session: ParticipantSession): void {
    const { participant } = session.progress;
    const forget = () => forgetSession({ study: this.#asked.study, participant });
    this.#running = new SessionFlow(session, { host: this.#host, page: this.#page, forget });
    this.#running.begin();
  }

  /** Returns the study's language that the user of the browser reads, or one of the page without a study. */
  #languageOf(study: PublicStudy | null): string {
    return preferredLanguage(study?.languages ?? shippedLanguages, this.#page.languages);
  }

  #phrasesOf(study: PublicStudy | null): Phrases {
    return phrasesOf(study ?? {}, this.#languageOf(study));
  }

  #fault(error: unknown): { readonly phrases: Phrases; readonly text: string } {
    const phrases = this.#phrasesOf(null);
    const unknown = error instanceof ServerRefusal && error.status === 404 && !(error instanceof NoStudyServer);
    const text = unknown
      ? phrases.say('entrance.noStudy', { study: this.#asked.study })
      : localizedReason(error, phrases);
    return { phrases, text };
  }

  /**
   * Asks for participant and invitation if the address lacks them. `complaint` is what was wrong with the address, in
   * the language of `phrases`.
   */
  #askWho(study: PublicStudy | null, phrases = this.#phrasesOf(study), complaint: string | null = null): void {
    const { display, address } = this.#page;
    // A link that is pasted into the address of this tab may change its fragment only.
    address.reloadWhenChanged();
    display.ask({
      kind: 'participant',
      phrases,
      complaint,
      known: { participant: this.#asked.participant, invitation: address.invitation() },
      go: (invited) => address.goTo(invited),
      decline: () => display.ask({ kind: 'declined', phrases, title: phrases.say('study') }),
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
          const complaint =
            contact === null
              ? phrases.say('entrance.wrongInvitation', { participant })
              : phrases.say('entrance.wrongInvitationRemote', { participant, contact });
          this.#askWho(study, phrases, complaint);
          return null;
        }
        if (taken === 'changed') {
          this.#page.address.reload();
          return null;
        }
        if ('why' in taken) {
          return `${formatSentence(localizedReason(taken.why, phrases))} ${contact ?? phrases.say('askExperimenter')}`;
        }
        this.#begin(taken);
        return null;
      },
      decline: (phrases) =>
        display.ask({ kind: 'declined', phrases, title: inLanguage(study.title, phrases.language) }),
    });
  }
}
