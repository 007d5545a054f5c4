import { reasonOf } from 'threepoint/core';
import { button, chooser, element, pageFolder, ServerPresence } from 'threepoint-ui';
import { createExperimenterClient, type ExperimenterClient, noStudiesHere } from '../client/study-client';
import type { RecordedStudy, StudyListing } from '../model/progress/study-api';

/**
 * The key under which the session storage keeps the token while the tab is open. It is not kept longer, because
 * computers are shared.
 */
const tokenKey = 'threepoint-experimenter-token';

/** The studies of this server, for a page whose user has entered the experimenter's token. */
export class ExperimenterAccess {
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

  /** The studies of the server as they were last requested. */
  get listed(): readonly StudyListing[] {
    return this.#listed;
  }

  /** Signs in with the token of this tab, if there is one. */
  async resume(): Promise<void> {
    void this.#server.whenKnown().then((state) => {
      if (state === 'none') this.#onChange();
    });
    const token = sessionStorage.getItem(tokenKey);
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
      sessionStorage.removeItem(tokenKey);
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

/** Asks for the experimenter's token; `use` resolves with a complaint, or with null if the token is accepted. */
function signInForm(use: (token: string) => Promise<string | null>): HTMLElement {
  const input = element('input', {
    type: 'password',
    name: 'token',
    autocomplete: 'off',
    'aria-label': 'Token',
    size: 40,
  });
  const complaint = element('p', { class: 'complaint', role: 'alert' });
  complaint.hidden = true;
  const go = button('Open', () => void open(), { class: 'primary' });
  async function open(): Promise<void> {
    const token = input.value.trim();
    if (!token) return;
    go.disabled = true;
    const refusal = await use(token);
    go.disabled = false;
    complaint.hidden = refusal === null;
    complaint.textContent = refusal ?? '';
    if (refusal === null) sessionStorage.setItem(tokenKey, token);
  }
  input.addEventListener('keydown', ({ key }) => {
    if (key === 'Enter') void open();
  });
  return element(
    'div',
    { class: 'sign-in' },
    element('label', {}, element('span', {}, 'The experimenter’s token'), input),
    go,
    element('p', { class: 'soft' }, 'The server generates it at its first start and prints the path of its file.'),
    complaint,
  );
}
