import { sentence } from 'threepoint-ui/phrase-parts';
import { NoStudyServer, ServerRefusal } from '../client/study-client';
import { type Phrases, phrasesOf, preferredLanguage, shippedLanguages } from '../model/phrases/phrases';
import { inLanguage } from '../model/phrases/words';
import type { PublicStudy } from '../model/progress/study-api';
import { reasonFor } from './reasons';
import type { ParticipantSession } from './session/participant-session';
import type { Opened } from './study-opening';
import type { StudyPage } from './study-page';

type NewSession = Extract<Opened, { kind: 'new' }>;

export interface StudyEntranceOptions {
  readonly page: Pick<StudyPage, 'display' | 'address' | 'languages'>;
  /** Opens the session of this participant. */
  readonly open: (participant: string) => Promise<Opened>;
  /** Called with the session of the study. */
  readonly onSession: (session: ParticipantSession) => void;
}

/** Leads from the address to a session: participant, invitation and consent. */
export class StudyEntrance {
  readonly #study: string;
  readonly #participant: string | null;
  readonly #options: StudyEntranceOptions;

  /** `participant` null: the address names none. */
  constructor(
    { study, participant }: { readonly study: string; readonly participant: string | null },
    options: StudyEntranceOptions,
  ) {
    this.#study = study;
    this.#participant = participant;
    this.#options = options;
  }

  /** Resolves when the session is open or a form asks for missing input; faults are shown. */
  async enter(): Promise<void> {
    const participant = this.#participant;
    if (participant === null) {
      this.#askWho(null);
      return;
    }
    try {
      const opened = await this.#options.open(participant);
      const invitation = this.#options.page.address.invitation();
      if (opened.kind === 'resumed') this.#options.onSession(opened.session);
      else if (invitation === null) this.#askWho(opened.study);
      else this.#askForConsent(opened, participant, invitation);
    } catch (error) {
      this.#options.page.display.ask({ kind: 'fault', ...this.#fault(error) });
    }
  }

  /** Returns the study's language that the user of the browser reads, or one of the page without a study. */
  #languageOf(study: PublicStudy | null): string {
    const [first = 'en', ...others] = shippedLanguages;
    return preferredLanguage(study?.languages ?? [first, ...others], this.#options.page.languages);
  }

  #phrasesOf(study: PublicStudy | null): Phrases {
    return phrasesOf(study ?? {}, this.#languageOf(study));
  }

  #fault(error: unknown): { readonly phrases: Phrases; readonly text: string } {
    const phrases = this.#phrasesOf(null);
    const unknown = error instanceof ServerRefusal && error.status === 404 && !(error instanceof NoStudyServer);
    const text = unknown ? phrases.say('entrance.noStudy', { study: this.#study }) : reasonFor(error, phrases);
    return { phrases, text };
  }

  /**
   * Asks for participant and invitation if the address lacks them. `complaint` is what was wrong with the address, in
   * the language of `phrases`.
   */
  #askWho(study: PublicStudy | null, phrases = this.#phrasesOf(study), complaint: string | null = null): void {
    const { display, address } = this.#options.page;
    // A link that is pasted into the address of this tab may change its fragment only.
    address.reloadWhenChanged();
    display.ask({
      kind: 'participant',
      phrases,
      complaint,
      known: { participant: this.#participant, invitation: address.invitation() },
      go: (invited) => address.goTo(invited),
      decline: () => display.ask({ kind: 'declined', phrases, title: phrases.say('study') }),
    });
  }

  #askForConsent({ study, agree }: NewSession, participant: string, invitation: string): void {
    const { display } = this.#options.page;
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
          this.#options.page.address.reload();
          return null;
        }
        if ('why' in taken) {
          return `${sentence(reasonFor(taken.why, phrases))} ${contact ?? phrases.say('askExperimenter')}`;
        }
        this.#options.onSession(taken);
        return null;
      },
      decline: (phrases) =>
        display.ask({ kind: 'declined', phrases, title: inLanguage(study.title, phrases.language) }),
    });
  }
}
