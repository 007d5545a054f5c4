import { reasonOf } from '../../core/errors/reasons';
import { NoStudyServer, ServerRefusal } from '../../net/study-client';
import { sentence } from '../../ui/phrases';
import type { ParticipantSession } from './participant-session';
import type { Opened } from './study-opening';
import type { StudyPage } from './study-page';

type NewSession = Extract<Opened, { kind: 'new' }>;

export interface StudyEntranceOptions {
  readonly page: Pick<StudyPage, 'display' | 'address'>;
  /** Opens the session of this participant, as study-opening says. */
  readonly open: (participant: string) => Promise<Opened>;
  /** The session that the study goes on with. */
  readonly onSession: (session: ParticipantSession) => void;
}

/** From the address to a session: who takes part, with which invitation, and their consent. */
export class StudyEntrance {
  readonly #study: string;
  readonly #participant: string | null;
  readonly #options: StudyEntranceOptions;

  /** What the address says; `participant` null: it names none. */
  constructor(
    { study, participant }: { readonly study: string; readonly participant: string | null },
    options: StudyEntranceOptions,
  ) {
    this.#study = study;
    this.#participant = participant;
    this.#options = options;
  }

  /** Resolves when the session is open or a form asks for what is missing; what goes wrong is shown. */
  async enter(): Promise<void> {
    const participant = this.#participant;
    if (participant === null) {
      this.#askWho();
      return;
    }
    try {
      const opened = await this.#options.open(participant);
      const invitation = this.#options.page.address.invitation();
      if (opened.kind === 'resumed') this.#options.onSession(opened.session);
      else if (invitation === null) this.#askWho();
      else this.#askForConsent(opened, participant, invitation);
    } catch (error) {
      this.#options.page.display.ask({ kind: 'fault', text: this.#faultText(error) });
    }
  }

  #faultText(error: unknown): string {
    return error instanceof ServerRefusal && error.status === 404 && !(error instanceof NoStudyServer)
      ? `There is no study "${this.#study}" on this server. Compare the address with your link.`
      : reasonOf(error);
  }

  /** Participant and invitation, as far as the address does not say them; `complaint`: what was wrong with what it says. */
  #askWho(complaint: string | null = null): void {
    const { display, address } = this.#options.page;
    // A whole link put into the address of this tab may differ behind "#" alone.
    address.reloadWhenChanged();
    display.ask({
      kind: 'participant',
      complaint,
      known: { participant: this.#participant, invitation: address.invitation() },
      go: (invited) => address.goTo(invited),
      decline: () => display.ask({ kind: 'declined', title: 'Study' }),
    });
  }

  #askForConsent({ study, agree }: NewSession, participant: string, invitation: string): void {
    const { display } = this.#options.page;
    display.ask({
      kind: 'consent',
      study,
      participant,
      agree: async (choices) => {
        const taken = await agree(choices, invitation);
        if (taken === 'uninvited') {
          const help = study.contact === null ? ', or ask the experimenter.' : `. ${study.contact}`;
          this.#askWho(`This is not the invitation of ${participant}. Compare it with your link${help}`);
          return null;
        }
        if ('why' in taken) return `${sentence(taken.why)} ${study.contact ?? 'Ask the experimenter.'}`;
        this.#options.onSession(taken);
        return null;
      },
      decline: () => display.ask({ kind: 'declined', title: study.title }),
    });
  }
}
