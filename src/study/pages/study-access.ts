import { reasonOf } from 'threepoint/core/errors/reasons';
import { ServerPresence } from 'threepoint-http/server-presence';
import { button, element } from 'threepoint-ui/element';
import { chooser } from 'threepoint-ui/fields';
import { pageFolder } from 'threepoint-ui/page-folder';
import { createExperimenterClient, type ExperimenterClient, noStudiesHere } from '../client/study-client';
import type { RecordedStudy, StudyListing } from '../model/progress/study-api';
import { forgetToken, keptToken, signInForm } from './sign-in';

/** The studies of this server, for a page whose user has entered the experimenter's token. */
export class StudyAccess {
  readonly #onChange: () => void;
  readonly #onAsked: (study: string) => void;
  readonly #server = new ServerPresence(pageFolder(), () => undefined);
  #client: ExperimenterClient | null = null;
  #listed: readonly StudyListing[] = [];

  /**
   * `onChange` is called when the token is accepted and when no server is found. `onAsked` is called after that with
   * the study in the address.
   */
  constructor(onChange: () => void, onAsked: (study: string) => void) {
    this.#onChange = onChange;
    this.#onAsked = onAsked;
  }

  /** The client; null: no token was accepted yet. */
  get client(): ExperimenterClient | null {
    return this.#client;
  }

  get listed(): readonly StudyListing[] {
    return this.#listed;
  }

  /** Signs in with the token of this tab, if there is one. */
  async resume(): Promise<void> {
    void this.#server.whenKnown().then((state) => {
      if (state === 'none') this.#onChange();
    });
    const token = keptToken();
    if (token !== null) await this.#signIn(token);
  }

  /**
   * Resolves with plan and records of a study under this version of its plan or the newest one, and puts the study into
   * the address.
   */
  async open(client: ExperimenterClient, id: string, version?: number): Promise<RecordedStudy> {
    const recorded = await client.records(id, version);
    const address = new URL(location.href);
    address.searchParams.set('study', id);
    history.replaceState(null, '', address);
    return recorded;
  }

  /** Requests the list of studies again. */
  async list(client: ExperimenterClient): Promise<void> {
    this.#listed = await client.studies();
  }

  /** Returns the form for the token, or a message on a host without a server. */
  form(): HTMLElement {
    if (this.#server.state !== 'none') return signInForm((token) => this.#signIn(token));
    const ask = button('Ask again', () => void this.#server.refresh().then(() => this.#onChange()));
    return element('div', { class: 'bar' }, element('p', { role: 'status' }, noStudiesHere), ask);
  }

  /** Returns the list of studies; `none` is its text without any. `choose` receives an id or an empty text. */
  select(chosen: string | undefined, none: string, choose: (id: string) => void): HTMLElement {
    const studies = this.#listed.map(({ id, title, simulated }) => {
      const marked = simulated && !title.startsWith('SIMULATED') ? `SIMULATED: ${title}` : title;
      return { id, label: `${marked} (${id})` };
    });
    const first = { id: '', label: studies.length === 0 ? none : 'Choose a study' };
    return chooser('Study', [first, ...studies], chosen ?? '', (id) => {
      // The page does not redraw a list that has the focus.
      if (document.activeElement instanceof HTMLElement) document.activeElement.blur();
      choose(id);
    });
  }

  signOutButton(): HTMLElement {
    return button('Sign out', () => {
      forgetToken();
      location.reload();
    });
  }

  /** Resolves with a complaint, or with null if the token is accepted. */
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
