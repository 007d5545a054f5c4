import { reasonOf } from 'threepoint/core/errors/reasons';
import { ServerPresence } from 'threepoint-http/server-presence';
import { button, element } from 'threepoint-ui/element';
import { pageFolder } from 'threepoint-ui/page-folder';
import { createExperimenterClient, type ExperimenterClient, noStudiesHere } from '../client/study-client';
import type { RecordedStudy, StudyListing } from '../model/progress/study-api';
import { forgetToken, keptToken, signInForm } from './sign-in';
import { studySelect } from './study-select';

/** The studies of this server, as a page sees them whose visitor has given the experimenter's token. */
export class StudyAccess {
  readonly #onChange: () => void;
  readonly #onAsked: (study: string) => void;
  readonly #server = new ServerPresence(pageFolder(), () => undefined);
  #client: ExperimenterClient | null = null;
  #listed: readonly StudyListing[] = [];

  /**
   * `onChange` hears when the token has opened the server, and when there turns out to be none; `onAsked`, once it has, which study the
   * address asks for.
   */
  constructor(onChange: () => void, onAsked: (study: string) => void) {
    this.#onChange = onChange;
    this.#onAsked = onAsked;
  }

  /** null: no token has opened the server yet. */
  get client(): ExperimenterClient | null {
    return this.#client;
  }

  get listed(): readonly StudyListing[] {
    return this.#listed;
  }

  /** Signs in with the token of this tab, where there is one. */
  async resume(): Promise<void> {
    void this.#server.known().then((state) => {
      if (state === 'none') this.#onChange();
    });
    const token = keptToken();
    if (token !== null) await this.#signIn(token);
  }

  /** Plan and records of a study, of this version of its plan or of the newest, which the address asks for from now on. */
  async open(client: ExperimenterClient, id: string, version?: number): Promise<RecordedStudy> {
    const recorded = await client.records(id, version);
    const address = new URL(location.href);
    address.searchParams.set('study', id);
    history.replaceState(null, '', address);
    return recorded;
  }

  /** Asks the server for its studies again. */
  async list(client: ExperimenterClient): Promise<void> {
    this.#listed = await client.studies();
  }

  /** Where the token is given; on a host without a server, a sentence in its place. */
  form(): HTMLElement {
    if (this.#server.state !== 'none') return signInForm((token) => this.#signIn(token));
    const ask = button('Ask again', () => void this.#server.ask().then(() => this.#onChange()));
    return element('div', { class: 'bar' }, element('p', { role: 'status' }, noStudiesHere), ask);
  }

  /** The list of studies; `none`: what it says without any. */
  select(chosen: string | undefined, none: string, choose: (id: string) => void): HTMLElement {
    const list = studySelect(this.#listed, chosen, none, choose);
    return element('label', {}, element('span', {}, 'Study'), list);
  }

  forgetButton(): HTMLElement {
    return button('Forget the token', () => {
      forgetToken();
      location.reload();
    });
  }

  /** Answers with a complaint, or null where the token opens. */
  async #signIn(token: string): Promise<string | null> {
    const candidate = createExperimenterClient(token, pageFolder());
    try {
      await this.list(candidate);
    } catch (error) {
      return reasonOf(error);
    }
    this.#client = candidate;
    this.#onChange();
    const asked = new URLSearchParams(location.search).get('study');
    if (asked) this.#onAsked(asked);
    return null;
  }
}
